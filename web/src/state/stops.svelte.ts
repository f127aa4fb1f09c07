/** Stop and E-stop: they need no lease, wait for no other command, and what was not confirmed stays in sight. */
import type { Urgent } from "../contract/types";
import type { Api } from "../net/api";
import { ApiError, messageOf } from "../net/errors";
import { settled } from "../rules/stopping";
import type { OpenStopLine, StopLine } from "../net/stopChannel";
import type { Notices } from "./notices.svelte";

/** A Stop or E-stop that was not answered; `rig` is null where none was known to send it to. */
export interface Unconfirmed {
  what: Urgent;
  rig: string | null;
  why: string;
}

export class Stops {
  /** Kept until one is confirmed, the rig is seen to have stopped, or a person puts it away. */
  unconfirmed: Unconfirmed | null = $state.raw(null);
  /** Of the stop channel [ms]; null while it is down, and stops go over HTTP. */
  roundTripMs: number | null = $state(null);

  readonly #line: StopLine;
  #presses = 0;
  /** The newest press of each kind that was answered. */
  readonly #confirmed: Record<Urgent, number> = { stop: 0, estop: 0 };

  constructor(
    private readonly api: Api,
    private readonly notices: Notices,
    /** The rig that is operated. */
    private readonly operated: () => string | null,
    open: OpenStopLine,
  ) {
    this.#line = open(
      (ms) => (this.roundTripMs = ms),
      () => undefined,
    );
  }

  close(): void {
    this.#line.close();
  }

  stop = (): Promise<void> => this.#press("stop", this.operated());
  estop = (): Promise<void> => this.#press("estop", this.operated());

  /** Presses once more what was not confirmed, at the rig it was meant for. */
  again = async (): Promise<void> => {
    if (this.unconfirmed) await this.#press(this.unconfirmed.what, this.unconfirmed.rig ?? this.operated());
  };

  putAway = (): void => {
    this.unconfirmed = null;
  };

  /** Takes in a state of the operated rig: it may show that there is nothing left to press for. */
  observe(state: string): void {
    const { unconfirmed } = this;
    const ours = unconfirmed && (unconfirmed.rig ?? this.operated()) === this.operated();
    if (ours && settled(unconfirmed.what, state)) this.unconfirmed = null;
  }

  async #press(what: Urgent, rig: string | null): Promise<void> {
    const press = ++this.#presses;
    if (rig === null) {
      this.unconfirmed = { what, rig, why: "this console knows no rig yet" };
      return;
    }
    try {
      const done = (await this.#line.press(what, rig)) ?? (await this.api[what](rig));
      this.#answered(what, rig, press);
      if (!done.unknown) return;
      // Where no rig process runs there is nothing left to press for: said, and no alarm.
      if (settled(what, done.state_after)) this.notices.say("info", done.unknown);
      else this.unconfirmed = { what, rig, why: done.unknown };
    } catch (error) {
      if (error instanceof ApiError && error.status === 409) {
        // Asked of a rig that does not move: said, but no alarm.
        this.#answered(what, rig, press);
        this.notices.say("info", error.message);
      } else if (press > this.#confirmed[what]) this.unconfirmed = { what, rig, why: messageOf(error) };
    }
  }

  #answered(what: Urgent, rig: string, press: number): void {
    this.#confirmed[what] = Math.max(this.#confirmed[what], press);
    if (this.unconfirmed?.what === what && (this.unconfirmed.rig ?? rig) === rig) this.unconfirmed = null;
  }
}
