/** A list of the server's that is searched, by words and by a tag. */
import type { Searched } from "../contract/types";
import type { Page } from "../net/request";
import { Pages } from "./pages.svelte";

/** A person types on meanwhile. */
const PAUSE_MS = 200;

export class Search<Row> {
  words = $state("");
  tag: string | null = $state(null);
  /** What was found; null where nothing is searched for. Of another search it stays until that is answered. */
  found: Pages<Row> | null = $state.raw(null);

  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Of two searches the one asked for last counts, whichever is answered first. */
  #turn = 0;

  constructor(
    private readonly ask: (before: string | null, wanted: Searched) => Promise<Page<Row>>,
    private readonly keyOf: (row: Row) => string,
    private readonly pauseMs = PAUSE_MS,
  ) {}

  /** Searches for words, once no more are typed. */
  type(words: string): void {
    this.words = words;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => void this.#search(), this.pauseMs);
  }

  /** Searches for what has a tag; null: any or none. */
  async narrow(tag: string | null): Promise<void> {
    this.tag = tag;
    await this.#search();
  }

  /** Reads again what was found. */
  async refresh(): Promise<void> {
    await this.found?.refresh();
  }

  /** Takes a row in the place of the one with its key, where that was found. */
  put(row: Row): void {
    this.found?.put(row);
  }

  drop(key: string): void {
    this.found?.drop(key);
  }

  async #search(): Promise<void> {
    clearTimeout(this.#timer);
    const turn = ++this.#turn;
    const wanted: Searched = { q: this.words.trim() || null, tag: this.tag };
    if (wanted.q === null && wanted.tag === null) {
      this.found = null;
      return;
    }
    const found = new Pages<Row>((before) => this.ask(before, wanted), this.keyOf);
    await found.refresh();
    if (turn === this.#turn) this.found = found;
  }
}
