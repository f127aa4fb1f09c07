/** Sends the newest of a fast series of values: one request at a time, what is overtaken is never sent. */
export class Latest<T> {
  #next: { value: T } | null = null;
  #sending = false;

  constructor(
    private readonly send: (value: T) => Promise<unknown>,
    private readonly failed: (error: unknown) => void,
  ) {}

  put(value: T): void {
    this.#next = { value };
    if (!this.#sending) void this.#run();
  }

  async #run(): Promise<void> {
    this.#sending = true;
    while (this.#next !== null) {
      const { value } = this.#next;
      this.#next = null;
      try {
        await this.send(value);
      } catch (error) {
        this.failed(error);
      }
    }
    this.#sending = false;
  }
}
