/**
 * The lease of the operated rig: whether this tab may command, and the token that each of its commands carries.
 *
 * Its secret, and that of a request which may be granted yet, are the tab's alone: a reload of the page keeps them.
 */
import type { Lease, LeaseGiven, LeaseToken, Snapshot } from "../contract/types";
import type { Api } from "../net/api";
import { ApiError, messageOf } from "../net/errors";
import { me } from "../net/identity";
import type { Notices } from "./notices.svelte";

/** What a tab keeps of one rig's lease. */
interface Kept {
  token: LeaseToken | null;
  asked: string | null;
}

const NOTHING: Kept = { token: null, asked: null };

export class RigLease {
  #rig: string | null = null;
  #token: LeaseToken | null = $state.raw(null);
  /** The secret that is the lease's once it is granted to us. */
  #asked: string | null = null;

  /** Ours it is while we are its holder, in the epoch we were given. */
  readonly held: boolean;

  constructor(
    private readonly api: Api,
    private readonly notices: Notices,
    private readonly session: () => Snapshot | null,
  ) {
    this.held = $derived(this.#token !== null && holds(this.session(), this.#token));
  }

  /** That of another rig, or of none. */
  of(rig: string | null): void {
    this.#rig = rig;
    const kept = rig === null ? NOTHING : restored(rig);
    this.#token = kept.token;
    this.#asked = kept.asked;
  }

  /** Takes in what the stream says of it: another operator may have granted what we asked for. */
  observe(lease: Lease): void {
    if (this.#rig === null || this.#asked === null) return;
    if (lease.holder === me() && lease.epoch !== this.#token?.epoch) {
      this.#own(this.#rig, { ...lease, secret: this.#asked });
    }
  }

  /** The token of one more command; null where there is none. */
  next(): LeaseToken | null {
    if (this.#token === null || this.#rig === null) return null;
    const next = { ...this.#token, sequence: this.#token.sequence + 1 };
    this.#keep(this.#rig, { token: next, asked: this.#asked });
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
      await this.api.lease(rig, "release", this.#token?.secret);
      this.#keep(rig, NOTHING);
    });

  /** Hands it to the first of those who asked. */
  grant = (): Promise<void> => this.#with((rig) => this.api.lease(rig, "grant", this.#token?.secret));

  /** Says that we are still here. A network that is silent says so by itself. */
  async renew(): Promise<void> {
    if (!this.held || this.#rig === null) return;
    try {
      await this.api.lease(this.#rig, "renew", this.#token?.secret);
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
    let given: LeaseGiven;
    try {
      given = await this.api.lease(rig, "request");
    } catch {
      throw refused;
    }
    this.#keep(rig, { token: this.#token, asked: given.secret ?? null });
    this.notices.say(
      "info",
      `${this.session()?.lease.holder ?? "Another operator"} has control, and was asked for it.`,
    );
  }

  #own(rig: string, { epoch, sequence, secret }: LeaseGiven): void {
    this.#keep(rig, { token: secret ? { epoch, sequence, secret } : null, asked: null });
  }

  #keep(rig: string, kept: Kept): void {
    if (rig === this.#rig) {
      this.#token = kept.token;
      this.#asked = kept.asked;
    }
    sessionStorage.setItem(keyOf(rig), JSON.stringify(kept));
  }
}

function holds(session: Snapshot | null, token: LeaseToken): boolean {
  return session !== null && session.lease.holder === me() && session.lease.epoch === token.epoch;
}

const keyOf = (rig: string): string => `fullpose.held.${rig}`;

function restored(rig: string): Kept {
  const text = sessionStorage.getItem(keyOf(rig));
  return text === null ? NOTHING : (JSON.parse(text) as Kept);
}
