/**
 * The lease of the operated rig: whether this tab may command, and the token that each of its commands carries.
 *
 * Its secret, and that of a request which may be granted yet, are the tab's alone: a reload of the page keeps them. A
 * person may have two tabs: the name says whose the lease is, the secret which tab's.
 */
import type { Lease, LeaseGiven, LeaseToken, Snapshot } from "../contract/types";
import type { Api } from "../net/api";
import { ApiError, messageOf } from "../net/errors";
import type { Notices } from "./notices.svelte";

/** A request for the lease: its secret is the lease's once it is granted to it, in an epoch after the one it was made in. */
interface Request {
  secret: string;
  epoch: number;
}

/** What a tab keeps of one rig's lease. */
interface Kept {
  token: LeaseToken | null;
  asked: Request | null;
  /** When the page went that held it [ms since 1970]: a reload takes again what its going gave up. */
  left?: number | null;
}

const NOTHING: Kept = { token: null, asked: null, left: null };
/** How long a page may take to come back for what it had [ms]. */
const RELOAD_MS = 15_000;

export class RigLease {
  #rig: string | null = null;
  #token: LeaseToken | null = $state.raw(null);
  #asked: Request | null = $state.raw(null);
  /** Whether a request is being compared with what was granted. */
  #comparing = false;
  #left: number | null = null;

  /** Ours it is while we are its holder, in the epoch we were given. */
  readonly held: boolean;
  /** Whether this tab has asked for it, and waits. */
  readonly asking: boolean;

  constructor(
    private readonly api: Api,
    private readonly notices: Notices,
    private readonly session: () => Snapshot | null,
    /** The name that the holder of the lease is known by, where it is ours. */
    private readonly me: () => string,
  ) {
    const lease = $derived(this.session()?.lease ?? null);
    this.held = $derived(
      this.#token !== null && lease !== null && lease.holder === this.me() && lease.epoch === this.#token.epoch,
    );
    this.asking = $derived(this.#asked !== null && lease !== null && lease.requested_by.includes(this.me()));
  }

  /** That of another rig, or of none. */
  of(rig: string | null): void {
    this.#rig = rig;
    const kept = rig === null ? NOTHING : restored(rig, this.me());
    this.#token = kept.token;
    this.#asked = kept.asked;
    this.#left = kept.left ?? null;
  }

  /** The page goes, perhaps for good: what this tab holds is given up, or others would wait until it counts as silent. */
  leave(): void {
    for (const rig of keptByTab()) {
      const kept = restored(rig, this.me());
      if (kept.token === null) continue;
      this.api.leave(rig, kept.token.secret).catch(() => undefined); // then it falls silent by itself
      this.#keep(rig, { ...kept, left: Date.now() });
    }
  }

  /** Takes in what the stream says of it: another operator may have granted what we asked for. */
  observe(lease: Lease): void {
    this.#comeBack(lease);
    const [rig, asked] = [this.#rig, this.#asked];
    if (rig === null || asked === null || lease.epoch === asked.epoch || lease.holder !== this.me()) return;
    if (lease.epoch !== this.#token?.epoch) void this.#compare(rig, asked, lease);
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

  /** Takes it from who holds it; the audit log says so, and why. */
  takeOver = (reason: string | null): Promise<void> =>
    this.#with(async (rig) => this.#own(rig, await this.api.lease(rig, "takeover", undefined, reason)));

  release = (): Promise<void> =>
    this.#with(async (rig) => {
      await this.api.lease(rig, "release", this.#token?.secret);
      this.#keep(rig, NOTHING);
    });

  /** Gives up, before a person leaves, what this tab holds on every rig; what does not succeed falls silent by itself. */
  async giveUp(): Promise<void> {
    const given = keptByTab().map(async (rig) => {
      const { token } = restored(rig, this.me());
      this.#keep(rig, NOTHING);
      if (token !== null) await this.api.lease(rig, "release", token.secret);
    });
    await Promise.allSettled(given);
  }

  /** Hands it to the first of those who asked. */
  grant = (): Promise<void> => this.#with((rig) => this.api.lease(rig, "grant", this.#token?.secret));

  /** Says that we are still here. A network that is silent says so by itself. */
  async renew(): Promise<void> {
    const [rig, token] = [this.#rig, this.#token];
    if (!this.held || rig === null || token === null) return;
    try {
      await this.api.lease(rig, "renew", token.secret);
    } catch (error) {
      if (!(error instanceof ApiError) || error.status === 0) return;
      this.notices.say("problem", messageOf(error));
      // Not its secret: another tab's, or of a process that is gone. A command may have counted its token on meanwhile.
      if (error.status === 403 && this.#token?.secret === token.secret)
        this.#keep(rig, { token: null, asked: this.#asked });
    }
  }

  #comeBack(lease: Lease): void {
    const left = this.#left;
    if (left === null || (lease.holder === this.me() && Date.now() - left < RELOAD_MS)) return; // not given up yet
    this.#left = null;
    if (lease.holder === null && Date.now() - left < RELOAD_MS) void this.take();
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
    this.#keep(rig, { token: this.#token, asked: given.secret ? { secret: given.secret, epoch: given.epoch } : null });
    const holder = given.holder === this.me() ? "Another window of yours" : (given.holder ?? "Another operator");
    this.notices.say("info", `${holder} has control, and was asked for it.`);
  }

  /** Whether it was granted to our request, or to another tab of ours: only the server can tell. */
  async #compare(rig: string, asked: Request, lease: Lease): Promise<void> {
    if (this.#comparing) return;
    this.#comparing = true;
    try {
      const { epoch, sequence } = await this.api.lease(rig, "renew", asked.secret);
      this.#own(rig, { ...lease, epoch, sequence, secret: asked.secret });
    } catch (error) {
      if (error instanceof ApiError && error.status !== 0) this.#keep(rig, { token: this.#token, asked: null });
    } finally {
      this.#comparing = false;
    }
  }

  #own(rig: string, { epoch, sequence, secret }: LeaseGiven): void {
    this.#keep(rig, { token: secret ? { epoch, sequence, secret } : null, asked: null });
  }

  #keep(rig: string, kept: Kept): void {
    if (rig === this.#rig) {
      this.#token = kept.token;
      this.#asked = kept.asked;
      this.#left = kept.left ?? null;
    }
    sessionStorage.setItem(keyOf(rig), JSON.stringify({ ...kept, who: this.me() }));
  }
}

const KEY = "fullpose.held.";
const keyOf = (rig: string): string => `${KEY}${rig}`;

/** The rigs whose lease this tab has kept something of. */
const keptByTab = (): string[] =>
  Object.keys(sessionStorage).flatMap((key) => (key.startsWith(KEY) ? [key.slice(KEY.length)] : []));

/** What was kept under this name: another person's is none of ours. */
function restored(rig: string, who: string): Kept {
  const text = sessionStorage.getItem(keyOf(rig));
  const kept = text === null ? null : (JSON.parse(text) as Kept & { who?: string });
  return kept?.who === who ? kept : NOTHING;
}
