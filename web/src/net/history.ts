/** The last seconds of telemetry, as contiguous columns that a plot can draw without copying. */
import type { Sample } from "./telemetry";

export const CHANNELS = 18;
/** First channel of each group: four measured angles, four demanded, four measured rates, four demanded, two errors. */
export const CHANNEL = { measured: 0, demand: 4, measuredRate: 8, demandRate: 12, solveError: 16, trackingError: 17 };

export class History {
  readonly #time: Float64Array;
  readonly #channels: Float64Array[];
  #start = 0;
  #end = 0;

  /** Keeps the newest `capacity` samples. */
  constructor(readonly capacity: number) {
    // Twice the room: the window slides and is moved back once every `capacity` samples.
    this.#time = new Float64Array(2 * capacity);
    this.#channels = Array.from({ length: CHANNELS }, () => new Float64Array(2 * capacity));
  }

  get length(): number {
    return this.#end - this.#start;
  }

  /** Adds a sample; one whose time does not advance (a replay set back, a machine that started anew) takes the place of what is after it. */
  push(sample: Sample): void {
    while (this.length > 0 && !(sample.timeS > (this.#time[this.#end - 1] ?? -Infinity))) this.#end--;
    if (this.#end === this.#time.length) this.#slideBack();
    const at = this.#end;
    this.#time[at] = sample.timeS;
    for (let i = 0; i < 4; i++) {
      this.#set(CHANNEL.measured + i, at, sample.measured[i]);
      this.#set(CHANNEL.demand + i, at, sample.demand[i]);
      this.#set(CHANNEL.measuredRate + i, at, sample.measuredRate[i]);
      this.#set(CHANNEL.demandRate + i, at, sample.demandRate[i]);
    }
    this.#set(CHANNEL.solveError, at, sample.solveErrorDeg);
    this.#set(CHANNEL.trackingError, at, sample.trackingErrorDeg);
    this.#end++;
    if (this.length > this.capacity) this.#start++;
  }

  /** Ends the curves here: what comes next is not joined to them. */
  break(): void {
    const last = this.#time[this.#end - 1];
    if (this.length === 0 || last === undefined) return;
    if (this.#end === this.#time.length) this.#slideBack();
    this.#time[this.#end] = last + 1e-6;
    for (const column of this.#channels) column[this.#end] = NaN;
    this.#end++;
    if (this.length > this.capacity) this.#start++;
  }

  /** Times of the samples [s]. */
  time(): Float64Array {
    return this.#time.subarray(this.#start, this.#end);
  }

  channel(index: number): Float64Array {
    const column = this.#channels[index];
    if (!column) throw new RangeError(`no channel ${index}`);
    return column.subarray(this.#start, this.#end);
  }

  #set(channel: number, at: number, value: number | undefined): void {
    const column = this.#channels[channel];
    if (column) column[at] = value ?? NaN;
  }

  #slideBack(): void {
    for (const column of [this.#time, ...this.#channels]) column.copyWithin(0, this.#start, this.#end);
    this.#end -= this.#start;
    this.#start = 0;
  }
}
