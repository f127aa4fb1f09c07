/** A list of the server's, read a page at a time. */
import { messageOf } from "../net/errors";
import type { Page } from "../net/request";
import { extended, NOTHING, renewed } from "../rules/pages";

/** What a control needs that reads the next page. */
export interface Older {
  readonly next: string | null;
  readonly reading: boolean;
  more: () => Promise<void>;
}

export class Pages<Row> implements Older {
  /** Null until first read. */
  #known: Page<Row> | null = $state.raw(null);
  reading = $state(false);
  /** Why the list may not be what the server has; null where it was read. */
  problem: string | null = $state(null);
  /** Of two reads the one asked for last counts, whichever is answered first. */
  #turn = 0;

  readonly rows: readonly Row[] | null = $derived(this.#known?.rows ?? null);
  readonly next: string | null = $derived(this.#known?.next ?? null);

  constructor(
    private readonly ask: (before: string | null) => Promise<Page<Row>>,
    private readonly keyOf: (row: Row) => string,
  ) {}

  /** Reads the newest page again; what was read of the older ones stays. */
  refresh = (): Promise<void> =>
    this.#read(null, (newest) => (this.#known = renewed(newest, this.#known ?? NOTHING, this.keyOf)));

  /** Reads the next page, where there is one. */
  more = async (): Promise<void> => {
    if (this.next === null || this.reading) return;
    await this.#read(this.next, (older) => (this.#known = extended(this.#known ?? NOTHING, older, this.keyOf)));
  };

  /** Forgets what was read, and reads anew: another list is asked for. */
  async restart(): Promise<void> {
    this.#known = null;
    await this.refresh();
  }

  /** Takes a row in the place of the one with its key, where that is there. */
  put(row: Row): void {
    const known = this.#known;
    if (known)
      this.#known = { ...known, rows: known.rows.map((old) => (this.keyOf(old) === this.keyOf(row) ? row : old)) };
  }

  /** Takes out a row that is no more. */
  drop(key: string): void {
    const known = this.#known;
    if (known) this.#known = { ...known, rows: known.rows.filter((row) => this.keyOf(row) !== key) };
  }

  async #read(before: string | null, take: (page: Page<Row>) => void): Promise<void> {
    const turn = ++this.#turn;
    this.reading = true;
    try {
      const page = await this.ask(before);
      if (turn !== this.#turn) return;
      take(page);
      this.problem = null;
    } catch (error) {
      if (turn === this.#turn) this.problem = messageOf(error);
    } finally {
      if (turn === this.#turn) this.reading = false;
    }
  }
}
