/** The rig the console operates: its stream, its history, and the commands to it. */
import { api, ApiError, me, messageOf } from "../adapter/api";
import { History } from "../adapter/history";
import { NO_LINK, reduce, type Link, type LinkEvent } from "../adapter/link";
import { Stream } from "../adapter/stream";
import { sampleAt, type Batch, type Sample } from "../adapter/telemetry";
import type { Lease, LeaseToken, Snapshot } from "../contract/types";
import type { TimeAxis } from "../rules/axis";
import { dataAgeMs, freshness, looksStale, type Freshness } from "../rules/freshness";
import { settled, type Urgent } from "../rules/stopping";
import type { Feed } from "./feed";

/** Thirty a second, for a minute. */
const HISTORY = 1800;
const RENEW_MS = 2000;
const CLOCK_MS = 100;

export interface Note {
  id: number;
  tone: "info" | "problem";
  text: string;
}

/** A Stop or E-stop that was not answered; `rig` is null where none was known to send it to. */
export interface Unconfirmed {
  what: Urgent;
  rig: string | null;
  why: string;
}

class Operated implements Feed {
  name: string | null = $state(null);
  link: Link = $state.raw(NO_LINK);
  latest: Sample | null = $state.raw(null);
  /** Grows with every frame: what plots wait for. */
  frames = $state(0);
  /** Age of the data and what it comes to, looked at ten times a second and at every change of the link. */
  ageMs: number | null = $state(null);
  freshness: Freshness = $state("stale");
  busy = $state(false);
  notes: Note[] = $state.raw([]);
  /** Kept until one is confirmed, the rig is seen to have stopped, or a person puts it away. */
  unconfirmed: Unconfirmed | null = $state.raw(null);
  history = new History(HISTORY);

  #stream: Stream | null = null;
  #token: LeaseToken | null = $state.raw(null);
  #timers: number[] = [];
  #noteId = 0;
  #presses = 0;
  /** The newest press of each kind that was answered. */
  readonly #confirmed: Record<Urgent, number> = { stop: 0, estop: 0 };

  readonly session = $derived(this.link.session);
  readonly state = $derived(this.link.session?.state ?? null);
  readonly alarms = $derived(this.link.session?.alarms ?? []);
  readonly waiting = $derived(this.alarms.filter(({ acknowledged_by }) => !acknowledged_by));
  readonly unacknowledged = $derived(this.waiting.length);
  /** Ours is the lease while we are its holder, in the epoch we were given. */
  readonly leased = $derived(this.#token !== null && holds(this.session, this.#token));

  readonly stale = $derived(looksStale(this.link, this.freshness));
  readonly #lastS = $derived(this.stale && this.ageMs !== null ? Math.floor(this.ageMs / 1000) : 0);
  readonly axis: TimeAxis = $derived({ kind: "age", ageS: this.#lastS });

  open(name: string): void {
    if (this.name === name) return;
    this.close();
    this.name = name;
    this.#token = restoreToken(name);
    this.#stream = new Stream(api.streamUrl(name), {
      link: (event) => this.#link(event),
      batch: (batch) => this.#batch(batch),
    });
    this.#timers = [
      window.setInterval(() => this.#look(), CLOCK_MS),
      window.setInterval(() => void this.#renew(), RENEW_MS),
    ];
  }

  close(): void {
    this.#stream?.close();
    this.#stream = null;
    for (const id of this.#timers) window.clearInterval(id);
    this.#timers = [];
    this.name = null;
    this.link = NO_LINK;
    this.latest = null;
    this.history = new History(HISTORY);
    this.#token = null;
    this.notes = [];
    this.#look();
  }

  async command(command: string, args: object = {}): Promise<boolean> {
    const name = this.name;
    if (name === null) return false;
    this.busy = true;
    try {
      await api.command(name, command, args, this.#nextToken(name));
      return true;
    } catch (error) {
      this.note("problem", messageOf(error));
      return false;
    } finally {
      this.busy = false;
    }
  }

  /** Stop and E-stop have their own requests: they need no lease and wait for no other command. */
  stop = (): Promise<void> => this.#urgent("stop", this.name);
  estop = (): Promise<void> => this.#urgent("estop", this.name);

  /** Presses once more what was not confirmed, at the rig it was meant for. */
  async pressAgain(): Promise<void> {
    if (this.unconfirmed) await this.#urgent(this.unconfirmed.what, this.unconfirmed.rig ?? this.name);
  }

  async takeLease(): Promise<void> {
    const name = this.name;
    if (name === null) return;
    try {
      this.#own(name, await api.lease(name, "take"));
    } catch (error) {
      // Held by another: ask for it, and say so.
      if (error instanceof ApiError && error.status === 409) await this.#ask(name, error);
      else this.note("problem", messageOf(error));
    }
  }

  /** Takes the lease from who holds it; the audit log says so. */
  async takeOver(): Promise<void> {
    const name = this.name;
    if (name === null) return;
    try {
      this.#own(name, await api.lease(name, "takeover"));
    } catch (error) {
      this.note("problem", messageOf(error));
    }
  }

  async releaseLease(): Promise<void> {
    const name = this.name;
    if (name === null) return;
    try {
      await api.releaseLease(name);
      this.#keep(name, null);
    } catch (error) {
      this.note("problem", messageOf(error));
    }
  }

  async grantLease(): Promise<void> {
    if (this.name === null) return;
    try {
      await api.lease(this.name, "grant");
    } catch (error) {
      this.note("problem", messageOf(error));
    }
  }

  note(tone: Note["tone"], text: string): void {
    const id = ++this.#noteId;
    this.notes = [...this.notes.filter((note) => note.text !== text), { id, tone, text }].slice(-4);
    window.setTimeout(() => this.dismiss(id), tone === "problem" ? 12_000 : 5000);
  }

  dismiss(id: number): void {
    this.notes = this.notes.filter((note) => note.id !== id);
  }

  #link(event: LinkEvent): void {
    this.link = reduce(this.link, event);
    if (event.type !== "frame") this.#look();
    if (event.type === "opened" || event.type === "session") this.#settle(event.session.state);
    // Another operator granted what we asked for.
    const lease = this.session?.lease;
    if (this.name !== null && lease?.holder === me() && lease.epoch !== this.#token?.epoch) this.#own(this.name, lease);
  }

  #look(): void {
    const now = performance.now();
    this.ageMs = dataAgeMs(this.link, now);
    this.freshness = freshness(this.link, now);
  }

  #batch(batch: Batch): void {
    for (let row = 0; row < batch.count; row++) this.history.push(sampleAt(batch, row));
    this.latest = sampleAt(batch, batch.count - 1);
    this.frames++;
  }

  async #urgent(what: Urgent, rig: string | null): Promise<void> {
    const press = ++this.#presses;
    if (rig === null) {
      this.unconfirmed = { what, rig, why: "this console knows no rig yet" };
      return;
    }
    try {
      await (what === "stop" ? api.stop(rig) : api.estop(rig));
      this.#answered(what, rig, press);
    } catch (error) {
      if (error instanceof ApiError && error.status === 409) {
        // Asked of a rig that does not move: said, but no alarm.
        this.#answered(what, rig, press);
        this.note("info", error.message);
      } else if (press > this.#confirmed[what]) this.unconfirmed = { what, rig, why: messageOf(error) };
    }
  }

  #answered(what: Urgent, rig: string, press: number): void {
    this.#confirmed[what] = Math.max(this.#confirmed[what], press);
    if (this.unconfirmed?.what === what && (this.unconfirmed.rig ?? rig) === rig) this.unconfirmed = null;
  }

  #settle(state: string): void {
    const { unconfirmed, name } = this;
    if (unconfirmed && (unconfirmed.rig ?? name) === name && settled(unconfirmed.what, state)) this.unconfirmed = null;
  }

  async #ask(name: string, refusal: ApiError): Promise<void> {
    try {
      await api.lease(name, "request");
      this.note("info", `${this.session?.lease.holder ?? "Another operator"} has control, and was asked for it.`);
    } catch {
      this.note("problem", messageOf(refusal));
    }
  }

  async #renew(): Promise<void> {
    if (!this.leased || this.name === null) return;
    try {
      await api.lease(this.name, "renew");
    } catch (error) {
      if (error instanceof ApiError && error.status !== 0) this.note("problem", messageOf(error));
    }
  }

  #nextToken(name: string): LeaseToken | null {
    if (this.#token === null) return null;
    const next = { epoch: this.#token.epoch, sequence: this.#token.sequence + 1 };
    this.#keep(name, next);
    return next;
  }

  #own(name: string, lease: Lease): void {
    this.#keep(name, { epoch: lease.epoch, sequence: lease.sequence });
  }

  #keep(name: string, token: LeaseToken | null): void {
    this.#token = token;
    if (token) sessionStorage.setItem(tokenKey(name), JSON.stringify(token));
    else sessionStorage.removeItem(tokenKey(name));
  }
}

function holds(session: Snapshot | null, token: LeaseToken): boolean {
  return session !== null && session.lease.holder === me() && session.lease.epoch === token.epoch;
}

const tokenKey = (rig: string): string => `fullpose.lease.${rig}`;

/** A reload of the page keeps the lease: the token lives as long as the tab. */
function restoreToken(rig: string): LeaseToken | null {
  const text = sessionStorage.getItem(tokenKey(rig));
  return text === null ? null : (JSON.parse(text) as LeaseToken);
}

export const operated = new Operated();
