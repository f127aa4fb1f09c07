/** A moment on a stretch of time, played by the screen's clock. */
import type { Range } from "../rules/limits";
import { advance, within } from "../rules/transport";

export class Player {
  at = $state(0);
  speed = $state(1);
  playing = $state(false);

  #frame = 0;
  #last = 0;

  constructor(private readonly range: () => Range) {}

  seek = (at: number): void => {
    this.at = within(at, this.range());
  };

  play = (on: boolean): void => {
    cancelAnimationFrame(this.#frame);
    this.playing = on;
    if (!on) return;
    if (this.at >= this.range()[1]) this.at = this.range()[0];
    this.#last = performance.now();
    this.#frame = requestAnimationFrame(this.#tick);
  };

  setSpeed = (speed: number): void => {
    this.speed = speed;
  };

  #tick = (now: number): void => {
    const next = advance(this.at, Math.max(0, now - this.#last) / 1000, this.speed, this.range());
    this.#last = now;
    this.at = next.at;
    this.playing = next.playing;
    if (this.playing) this.#frame = requestAnimationFrame(this.#tick);
  };
}
