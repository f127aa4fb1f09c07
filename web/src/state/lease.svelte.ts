/** The lease of the operated rig: whether this tab may command, and the token that each of its commands carries. */
import type { Lease, LeaseToken, Snapshot } from "../contract/types";
import type { Api } from "../net/api";
import { ApiError, messageOf } from "../net/errors";
import { me } from "../net/identity";
import type { Notices } from "./notices.svelte";

export class RigLease {
  #rig: string | null = null;
  #token: LeaseToken | null = $state.raw(null);

  /** Ours it is while we are its holder, in the epoch we were given. */
  readonly held: boolean;

  constructor(
    private readonly api: Api,
    private readonly notices: Notices,
    private readonly session: () => Snapshot | null,
  ) {
    this.held = $derived(this.#token !== null && holds(this.session(), this.#token));
  }

  /** That of another rig, or of none. A reload of the page keeps it: the token lives as long as the tab. */
  of(rig: string | null): void {
    this.#rig = rig;
    this.#token = rig === null ? null : restored(rig);
  }

  /** Takes in what the stream says of it: another operator may have granted what we asked for. */
  observe(lease: Lease): void {
    if (this.#rig !== null && lease.holder === me() && lease.epoch !== this.#token?.epoch) this.#own(this.#rig, lease);
  }

  /** The token of one more command; null where there is none. */
  next(): LeaseToken | null {
    if (this.#token === null || this.#rig === null) return null;
    const next = { epoch: this.#token.epoch, sequence: this.#token.sequence + 1 };
    this.#keep(this.#rig, next);
    return next;
  }

  take = (): Promise<void> =>
    this.#with(async (rig) => {
      try {
        this.#own(rig, await this.api.lease(rig, "take"));
      } catch (error) {
        if (!(error instanceof ApiError && error.status === 409)) throw error;
        await this.#ask(rig, error); // held by another
      }
    });

  /** Takes it from who holds it; the audit log says so. */
  takeOver = (): Promise<void> => this.#with(async (rig) => this.#own(rig, await this.api.lease(rig, "takeover")));

  release = (): Promise<void> =>
    this.#with(async (rig) => {
      await this.api.releaseLease(rig);
      this.#keep(rig, null);
    });

  /** Hands it to the first of those who asked. */
  grant = (): Promise<void> => this.#with((rig) => this.api.lease(rig, "grant"));

  /** Says that we are still here. A network that is silent says so by itself. */
  async renew(): Promise<void> {
    if (!this.held || this.#rig === null) return;
    try {
      await this.api.lease(this.#rig, "renew");
    } catch (error) {
      if (error instanceof ApiError && error.status !== 0) this.notices.say("problem", messageOf(error));
    }
  }

  async #with(act: (rig: string) => Promise<unknown>): Promise<void> {
    if (this.#rig === null) return;
    try {
      await act(this.#rig);
    } catch (error) {
      this.notices.say("problem", messageOf(error));
    }
  }

  async #ask(rig: string, refused: ApiError): Promise<void> {
    try {
      await this.api.lease(rig, "request");
    } catch {
      throw refused;
    }
    this.notices.say(
      "info",
      `${this.session()?.lease.holder ?? "Another operator"} has control, and was asked for it.`,
    );
  }

  #own(rig: string, lease: Lease): void {
    this.#keep(rig, { epoch: lease.epoch, sequence: lease.sequence });
  }

  #keep(rig: string, token: LeaseToken | null): void {
    if (rig === this.#rig) this.#token = token;
    if (token) sessionStorage.setItem(keyOf(rig), JSON.stringify(token));
    else sessionStorage.removeItem(keyOf(rig));
  }
}

function holds(session: Snapshot | null, token: LeaseToken): boolean {
  return session !== null && session.lease.holder === me() && session.lease.epoch === token.epoch;
}

const keyOf = (rig: string): string => `fullpose.lease.${rig}`;

function restored(rig: string): LeaseToken | null {
  const text = sessionStorage.getItem(keyOf(rig));
  return text === null ? null : (JSON.parse(text) as LeaseToken);
}
