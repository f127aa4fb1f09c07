/** Who is signed in here, and whether one must be: as `GET /me` said last, whatever else hints at it. */
import type { Me, Person, Role } from "../contract/types";
import type { Api } from "../net/api";
import { ApiError } from "../net/errors";
import { me as tabName } from "../net/identity";
import { backoffMs } from "../net/keptSocket";
import { letIn, permitted, signedOutText } from "../rules/roles";
import type { Verdict } from "../rules/commands";
import type { Watch } from "../net/watched";

type Asked = Pick<Api, "me" | "login" | "logout">;

export class Identity implements Watch {
  /** What the server said last; null before it has said anything. */
  #me: Me | null = $state.raw(null);
  /** The server was asked and did not answer: who is there is not known, and Stop is not kept from anybody for that. */
  #silent = $state(false);
  /** Why one who was in must sign in again; null for one who only comes. */
  said: string | null = $state(null);

  readonly person: Person | null = $derived(this.#me?.person ?? null);
  readonly role: Role | null = $derived(this.person?.role ?? null);
  /** Whether one must sign in here. */
  readonly people: boolean = $derived(this.#me?.people ?? false);
  readonly provider: string | null = $derived(this.#me?.provider ?? null);
  /** What is shown: nothing yet, the sign-in page, or the console. */
  readonly place: "nothing" | "sign-in" | "console" = $derived(
    this.#me === null ? (this.#silent ? "console" : "nothing") : letIn(this.#me) ? "console" : "sign-in",
  );
  /** The name this tab commands under: the person's, else the tab's own. */
  readonly me: string = $derived(this.person?.name ?? tabName());
  /** Whether what needs an operator, or an admin, may be done. */
  readonly operator: Verdict = $derived(permitted("operator", this.role));
  readonly admin: Verdict = $derived(permitted("admin", this.role));

  #asking: Promise<void> | null = null;
  #anew = false;
  #misses = 0;

  constructor(private readonly api: Asked) {}

  /** Asks who is there. What is asked for meanwhile is asked once more: the answer under way may be older. */
  check = (): Promise<void> => {
    this.#anew = true;
    return (this.#asking ??= this.#ask().finally(() => (this.#asking = null)));
  };

  /** A refusal hints that the session has ended, or that the role is another; a network that fails hints at nothing. */
  failed = (error: unknown): void => {
    if (!(error instanceof ApiError)) return;
    const out = error.status === 401 && error.kind !== "login";
    if (out || (error.status === 403 && error.kind === "role")) void this.check();
  };

  refused = (): void => void this.check();

  /** Raises what the request raises. */
  async signIn(name: string, password: string): Promise<void> {
    const me = await this.api.login(name, password);
    if (!letIn(me)) throw new ApiError(401, "this person was shut out just now");
    this.take(me);
  }

  /** Raises what the request raises: then one is signed in yet. */
  async signOut(): Promise<void> {
    await this.api.logout();
    this.#me = { people: true, provider: this.provider, person: null };
    this.said = null;
    await this.check();
  }

  take(me: Me): void {
    const was = this.#me;
    this.#me = me;
    this.#silent = false;
    if (letIn(me)) this.said = null;
    else this.said ??= signedOutText(was);
  }

  async #ask(): Promise<void> {
    while (this.#anew) {
      this.#anew = false;
      try {
        this.take(await this.api.me());
        this.#misses = 0;
      } catch {
        this.#missed();
      }
    }
  }

  /** Before the first answer it is asked until there is one. */
  #missed(): void {
    if (this.#me !== null) return;
    this.#silent = true;
    this.#misses++;
    setTimeout(() => void this.check(), backoffMs(this.#misses, Math.random()));
  }
}
