/** Jobs of the server: their list, read again while any of them is under way. */
import type { Plan } from "../contract/types";
import { ApiError, messageOf } from "../net/errors";
import { backoffMs } from "../net/keptSocket";
import type { Page } from "../net/request";
import { extended, renewed } from "../rules/pages";
import type { Older } from "./pages.svelte";

export interface Job {
  id: string;
  status: string;
}

const idOf = (job: Job): string => job.id;
const POLL_MS = 250;
const UNFINISHED: ReadonlySet<string> = new Set<Plan["status"]>(["queued", "running"]);

export const unfinished = (job: Pick<Job, "status">): boolean => UNFINISHED.has(job.status);

const passing = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));

export class Jobs<J extends Job> implements Older {
  all: readonly J[] = $state.raw([]);
  /** Where the next page of the list begins; null where there is none. */
  next: string | null = $state(null);
  reading = $state(false);
  /** What kept the list or a job from being read the last time; null once it has been. */
  problem: string | null = $state(null);

  #polling = false;
  #closed = false;
  #reads = 0;
  #added = 0;

  constructor(
    private readonly list: (before: string | null) => Promise<Page<J>>,
    private readonly get: (id: string) => Promise<J>,
    private readonly wait: (ms: number) => Promise<void> = passing,
  ) {}

  async refresh(): Promise<void> {
    const read = ++this.#reads;
    try {
      let added: number;
      let newest: Page<J>;
      do {
        added = this.#added;
        newest = await this.list(null);
      } while (added !== this.#added); // a list that was asked for before a job was made does not hold it
      if (read !== this.#reads) return; // asked for anew meanwhile: that answer is the newer one
      this.#take(renewed(newest, { rows: this.all, next: this.next }, idOf));
      this.problem = null;
      void this.#poll();
    } catch (error) {
      if (read === this.#reads) this.problem = messageOf(error);
    }
  }

  /** Reads the next page of the list, where there is one. */
  more = async (): Promise<void> => {
    if (this.next === null || this.reading) return;
    this.reading = true;
    try {
      const older = await this.list(this.next);
      this.#take(extended({ rows: this.all, next: this.next }, older, idOf));
      this.problem = null;
      void this.#poll();
    } catch (error) {
      this.problem = messageOf(error);
    } finally {
      this.reading = false;
    }
  };

  /** Reads one job in full. Raises what the request raises. */
  async read(id: string): Promise<void> {
    this.#replace(await this.get(id));
  }

  /** Takes a job in, as the newest where it is new, and follows it to its end. */
  put(job: J): void {
    if (this.all.some(({ id }) => id === job.id)) this.#replace(job);
    else {
      this.#added++;
      this.all = [job, ...this.all];
    }
    void this.#poll();
  }

  /** Follows nothing any more. */
  close(): void {
    this.#closed = true;
  }

  #take(known: Page<J>): void {
    this.all = known.rows;
    this.next = known.next;
  }

  #replace(job: J): void {
    this.all = this.all.map((each) => (each.id === job.id ? job : each));
  }

  /** Follows what is under way to its end. A read that fails is tried again, ever more slowly; a job that is gone is gone. */
  async #poll(): Promise<void> {
    if (this.#polling) return;
    this.#polling = true;
    let misses = 0;
    while (this.all.some(unfinished)) {
      await this.wait(misses === 0 ? POLL_MS : backoffMs(misses, Math.random()));
      if (this.#closed) break;
      let problem: string | null = null;
      for (const { id } of this.all.filter(unfinished)) {
        try {
          await this.read(id);
        } catch (error) {
          if (error instanceof ApiError && error.status === 404) this.all = this.all.filter((job) => job.id !== id);
          else problem = messageOf(error);
        }
      }
      misses = problem === null ? 0 : misses + 1;
      this.problem = problem;
    }
    this.#polling = false;
  }
}
