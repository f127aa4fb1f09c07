/** Jobs of the server: their list, read again while any of them is under way. */
import { messageOf } from "../adapter/api";

export interface Job {
  id: string;
  status: string;
}

const POLL_MS = 250;
const UNFINISHED = new Set(["queued", "running"]);

export const unfinished = (job: Pick<Job, "status">): boolean => UNFINISHED.has(job.status);

export class Jobs<J extends Job> {
  all: J[] = $state.raw([]);
  problem: string | null = $state(null);

  #polling = false;

  constructor(
    private readonly list: () => Promise<J[]>,
    private readonly get: (id: string) => Promise<J>,
  ) {}

  async refresh(): Promise<void> {
    try {
      this.all = await this.list();
      this.problem = null;
      void this.#poll();
    } catch (error) {
      this.problem = messageOf(error);
    }
  }

  /** Reads one job in full. Raises what the request raises. */
  async read(id: string): Promise<void> {
    this.put(await this.get(id));
  }

  /** Takes a job in, as the newest where it is new, and follows it to its end. */
  put(job: J): void {
    const known = this.all.some(({ id }) => id === job.id);
    this.all = known ? this.all.map((each) => (each.id === job.id ? job : each)) : [job, ...this.all];
    void this.#poll();
  }

  async #poll(): Promise<void> {
    if (this.#polling) return;
    this.#polling = true;
    try {
      while (this.all.some(unfinished)) {
        await new Promise((resolve) => setTimeout(resolve, POLL_MS));
        for (const { id } of this.all.filter(unfinished)) await this.read(id);
      }
    } catch (error) {
      this.problem = messageOf(error);
    } finally {
      this.#polling = false;
    }
  }
}
