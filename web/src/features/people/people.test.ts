// @vitest-environment happy-dom
import { fireEvent, render, screen, within } from "@testing-library/svelte";
import { beforeEach, describe, expect, it } from "vitest";
import type { Me, Role, Token, User } from "../../contract/types";
import type { Api } from "../../net/api";
import { ApiError } from "../../net/errors";
import { makeLasting, type Lasting } from "../../state/stores";
import { TestConsole } from "../../testing/console";
import Account from "./Account.svelte";
import People from "./People.svelte";
import SignIn from "./SignIn.svelte";

beforeEach(() => sessionStorage.clear());

const as = (role: Role): Me => ({
  people: true,
  provider: null,
  person: { name: "ann", role, via: "session", until: null },
});
const NOBODY: Me = { people: true, provider: null, person: null };
const user = (given: Partial<User> = {}): User => ({
  name: "bob",
  role: "viewer",
  disabled: false,
  password: true,
  created: "2026-11-29T10:00:00Z",
  ...given,
});
const token = (given: Partial<Token> = {}): Token => ({
  id: "t1",
  user: "ann",
  role: null,
  label: "nightly",
  created: "2026-11-29T10:00:00Z",
  until: null,
  ...given,
});
const type = (label: string, value: string) => fireEvent.input(screen.getByLabelText(label), { target: { value } });
const press = (name: string) => fireEvent.click(screen.getByRole("button", { name }));
const asked = (console: TestConsole, what: string): unknown[][] =>
  console.asked.filter(([request]) => request === what).map(([, ...given]) => given);

function signedIn(role: Role, answers: object): TestConsole {
  const console = new TestConsole(answers);
  console.stores.identity.take(as(role));
  return console;
}

describe("the sign-in page", () => {
  function shown(login: () => Promise<Me>, me: Me = NOBODY): Lasting {
    const lasting = makeLasting({ login, me: () => Promise.resolve(me) } as unknown as Api);
    lasting.identity.take(me);
    render(SignIn, { props: { lasting } });
    return lasting;
  }

  it("says what was wrong, keeps the name, and lets in who is known", async () => {
    let answer: Promise<Me> = Promise.reject(new ApiError(401, "no such name with this password", [], "login"));
    const { identity } = shown(() => answer);
    expect(document.activeElement).toBe(screen.getByLabelText("Name"));
    await type("Name", "ann");
    await type("Password", "not it");
    await press("Sign in");
    expect((await screen.findByRole("alert")).textContent).toContain("no such name with this password");
    answer = Promise.reject(new ApiError(429, "too many attempts to sign in: try again in 42 s", [], "attempts"));
    await press("Sign in");
    await expect.poll(() => screen.queryByRole("alert")?.textContent).toContain("try again in 42 s");
    expect(screen.getByLabelText<HTMLInputElement>("Name").value).toBe("ann");
    answer = Promise.resolve(as("viewer"));
    await press("Sign in");
    await expect.poll(() => identity.place).toBe("console");
  });

  it("is what a password manager fills, and has the provider where there is one", () => {
    shown(() => Promise.reject(new Error()), { ...NOBODY, provider: "the institute" });
    const [name, password] = ["Name", "Password"].map((label) => screen.getByLabelText<HTMLInputElement>(label));
    expect([name?.autocomplete, password?.autocomplete, password?.type]).toEqual([
      "username",
      "current-password",
      "password",
    ]);
    const link = screen.getByRole("link", { name: "Sign in with the institute" });
    expect(link.getAttribute("href")).toBe("/api/v1/login/provider");
  });
});

describe("the account", () => {
  it("changes the password, and says what was refused", async () => {
    const answers: Record<string, unknown> = { tokens: [] };
    const console = signedIn("viewer", answers);
    console.show(Account, {});
    await type("Current password", "old");
    await type("New password", "a new sentence");
    await type("New password, again", "another");
    await press("Change the password");
    expect(screen.getByRole("alert").textContent).toContain("not the same");
    expect(asked(console, "changePassword")).toEqual([]);
    answers["changePassword"] = new ApiError(401, "this is not the current password", [], "login");
    await type("New password, again", "a new sentence");
    await press("Change the password");
    await expect.poll(() => screen.queryByRole("alert")?.textContent).toContain("not the current password");
    answers["changePassword"] = undefined;
    await fireEvent.click(screen.getByRole("checkbox", { name: "Revoke my tokens too" }));
    await press("Change the password");
    expect((await screen.findByRole("status")).textContent).toContain("tokens are revoked");
    expect(asked(console, "changePassword").at(-1)).toEqual(["old", "a new sentence", true]);
    expect(asked(console, "me")).toEqual([]); // a wrong password is no sign-out
  });

  it("makes a token, shows its secret, and revokes one once a person says so", async () => {
    const made = { ...token(), secret: "fp_secret" };
    const console = signedIn("operator", {
      tokens: [token(), token({ id: "t2", user: "bob", label: "of bob" })],
      makeToken: made,
      revokeToken: undefined,
    });
    console.show(Account, {});
    await type("What it is for", "nightly");
    expect(
      within(screen.getByLabelText("Role"))
        .getAllByRole("option")
        .map((each) => each.textContent),
    ).toEqual(["yours", "viewer", "operator"]);
    await press("Make");
    expect((await screen.findByLabelText<HTMLInputElement>("Secret of the token")).value).toBe("fp_secret");
    expect(asked(console, "makeToken")).toEqual([[{ label: "nightly", role: null, days: 90 }]]);
    expect(screen.queryByText("of bob")).toBeNull();
    await press("Revoke nightly");
    expect(asked(console, "revokeToken")).toEqual([]);
    await fireEvent.click(within(screen.getByRole("dialog")).getByRole("button", { name: "Revoke" }));
    await expect.poll(() => asked(console, "revokeToken")).toEqual([["t1"]]);
  });

  it("of nobody says how people come to be", () => {
    new TestConsole().show(Account, {});
    expect(screen.getByText(/fullpose user add NAME --role admin/)).toBeTruthy();
  });
});

describe("people", () => {
  it("are added, disabled, and given another role; the last admin stays one", async () => {
    const answers: Record<string, unknown> = {
      tokens: [],
      users: [user({ name: "ann", role: "admin" }), user()],
      addUser: user({ name: "cy" }),
      changeUser: user({ disabled: true }),
    };
    const console = signedIn("admin", answers);
    console.show(People, {});
    await type("Name", "cy");
    await press("Add");
    expect(asked(console, "addUser")).toEqual([[{ name: "cy", role: "viewer", password: null }]]);
    const bob = within((await screen.findByText("bob")).closest("li") as HTMLElement);
    await fireEvent.click(bob.getByRole("button", { name: "Disable…" }));
    await fireEvent.click(within(screen.getByRole("dialog")).getByRole("button", { name: "Disable" }));
    expect(asked(console, "changeUser")).toEqual([["bob", { disabled: true }]]);
    await expect.poll(() => screen.queryByText("disabled")).not.toBeNull();
    answers["changeUser"] = new ApiError(409, "ann is the last admin: make another one first", [], "person");
    const role = screen.getByLabelText<HTMLSelectElement>("Role of ann");
    await fireEvent.change(role, { target: { value: "viewer" } });
    expect((await screen.findByRole("alert")).textContent).toContain("the last admin");
    expect(role.value).toBe("admin");
  });

  it("are an admin's matter", () => {
    const console = signedIn("operator", {});
    console.show(People, {});
    expect(screen.getByText(/Your role is operator/)).toBeTruthy();
    expect(console.asked).toEqual([]);
  });
});
