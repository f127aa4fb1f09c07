/** Stop and E-stop: they need no lease, wait for no other command, and what was not confirmed stays in sight. */
import type { Api } from "../net/api";
import { ApiError, messageOf } from "../net/errors";
import { settled, type Urgent } from "../rules/stopping";
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

  #presses = 0;
  /** The newest press of each kind that was answered. */
  readonly #confirmed: Record<Urgent, number> = { stop: 0, estop: 0 };

  constructor(
    private readonly api: Api,
    private readonly notices: Notices,
    /** The rig that is operated. */
    private readonly operated: () => string | null,
  ) {}

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
      await (what === "stop" ? this.api.stop(rig) : this.api.estop(rig));
      this.#answered(what, rig, press);
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
