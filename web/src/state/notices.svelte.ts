/** What the console says in passing. */

export interface Notice {
  id: number;
  tone: "info" | "problem";
  text: string;
}

/** How long one stands before it goes by itself [ms], and how many stand at once. */
const SHOWN_MS: Record<Notice["tone"], number> = { info: 5000, problem: 12_000 };
const MOST = 4;

export class Notices {
  all: readonly Notice[] = $state.raw([]);
  #last = 0;

  /** Says it, once: the same text again takes the place of the one before. */
  say(tone: Notice["tone"], text: string): void {
    const id = ++this.#last;
    this.all = [...this.all.filter((notice) => notice.text !== text), { id, tone, text }].slice(-MOST);
    setTimeout(() => this.dismiss(id), SHOWN_MS[tone]);
  }

  dismiss(id: number): void {
    this.all = this.all.filter((notice) => notice.id !== id);
  }

  clear(): void {
    this.all = [];
  }
}
