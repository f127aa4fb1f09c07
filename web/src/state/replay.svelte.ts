/** A recorded run played again through the stream's protocol, with a clock of this console's own. */
import type { ReplayOf } from "../contract/types";
import { History } from "../net/history";
import { NO_LINK, reduce, type Link } from "../net/link";
import { RECORD_MS, type Connect, type Connection, type Listener } from "../net/stream";
import { sampleAt, type Batch, type Sample } from "../net/telemetry";
import type { TimeAxis } from "../rules/axis";
import type { Feed } from "./feed";

/** Thirty a second, for two minutes: what was played before a seek stays in sight. */
const HISTORY = 3600;

export class Replay implements Feed {
  link: Link = $state.raw(NO_LINK);
  of: ReplayOf | null = $state.raw(null);
  latest: Sample | null = $state.raw(null);
  frames = $state(0);
  /** Time after the run's first sample [s]. */
  at = $state(0);
  playing = $state(true);
  speed = $state(1);

  axis: TimeAxis = $state.raw({ kind: "run", zeroS: 0 });
  /** A record does not grow old. */
  readonly stale = false;

  readonly history = new History(HISTORY);
  readonly #stream: Connection;
  #opened = false;
  #sought = false;

  readonly session = $derived(this.link.session);
  readonly duration = $derived(this.of?.duration_s ?? 0);

  /** Plays what the stream at `url` brings. */
  constructor(url: string, connect: Connect) {
    const listener: Listener = {
      link: (event) => (this.link = reduce(this.link, event)),
      batch: (batch) => this.#batch(batch),
      replay: (of) => this.#open(of),
      replayed: ({ playing, factor }) => {
        this.playing = playing;
        this.speed = factor;
      },
    };
    this.#stream = connect(url, listener, RECORD_MS);
  }

  close(): void {
    this.#stream.close();
  }

  seek = (at: number): void => {
    this.at = Math.min(this.duration, Math.max(0, at));
    this.#sought = true;
    this.#stream.control({ type: "seek", time_s: this.at });
  };

  play = (on: boolean): void => this.#stream.control({ type: on ? "play" : "pause" });

  setSpeed = (factor: number): void => this.#stream.control({ type: "speed", factor });

  /** A connection that was lost goes on where it was: the server's clock of it is gone. */
  #open(of: ReplayOf): void {
    this.of = of;
    if (this.#opened) {
      this.#stream.control({ type: "speed", factor: this.speed });
      this.#stream.control({ type: "seek", time_s: this.at });
      this.#stream.control({ type: this.playing ? "play" : "pause" });
    }
    this.#opened = true;
  }

  #batch(batch: Batch): void {
    if (this.#sought) this.history.break();
    this.#sought = false;
    for (let row = 0; row < batch.count; row++) this.history.push(sampleAt(batch, row));
    this.latest = sampleAt(batch, batch.count - 1);
    this.at = Math.max(0, this.latest.wallS - (this.of?.started ?? this.latest.wallS));
    this.axis = { kind: "run", zeroS: this.latest.timeS - this.at };
    this.frames++;
  }
}
