// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Me, Role } from "../contract/types";
import { ApiError } from "../net/errors";
import { Identity } from "./identity.svelte";

const ANN: Me = {
  people: true,
  provider: null,
  person: { name: "ann", role: "operator", via: "session", until: null },
};
const NOBODY: Me = { people: true, provider: null, person: null };
const OPEN: Me = { people: false, provider: null, person: null };
const as = (role: Role): Me => ({ ...ANN, person: { name: "ann", role, via: "session", until: null } });

let asked: number;
let answer: Me | Error;

function identity(first: Me | Error): Identity {
  answer = first;
  asked = 0;
  const said = (): Promise<Me> => (answer instanceof Error ? Promise.reject(answer) : Promise.resolve(answer));
  return new Identity({
    me: () => {
      asked++;
      return said();
    },
    login: said,
    logout: () => Promise.resolve(undefined),
  });
}

beforeEach(() => {
  sessionStorage.clear();
  vi.useFakeTimers();
});
afterEach(() => vi.useRealTimers());

it("shows nothing before the first answer, then the console or the sign-in page", async () => {
  const who = identity(NOBODY);
  expect(who.place).toBe("nothing");
  await who.check();
  expect([who.place, who.said]).toEqual(["sign-in", null]);
  answer = ANN;
  await who.signIn("ann", "a password");
  expect([who.place, who.me, who.role]).toEqual(["console", "ann", "operator"]);
  const free = identity(OPEN);
  await free.check();
  expect([free.place, free.operator.enabled]).toEqual(["console", true]);
  expect(free.me).toMatch(/^console-/);
});

it("shows the console of a server that does not answer, and asks until it does", async () => {
  const who = identity(new ApiError(0, "silent"));
  await who.check();
  expect(who.place).toBe("console");
  answer = NOBODY;
  await vi.advanceTimersByTimeAsync(6000);
  expect(who.place).toBe("sign-in");
  expect(asked).toBe(2);
});

it("takes a refusal for a hint, a network that fails for none, and the server's word for it", async () => {
  const who = identity(ANN);
  await who.check();
  who.failed(new ApiError(0, "silent"));
  who.failed(new ApiError(409, "held"));
  who.failed(new ApiError(401, "not the current password", [], "login"));
  expect(asked).toBe(1);
  who.failed(new ApiError(401, "sign in first", [], "sign-in"));
  await who.check();
  expect(who.place).toBe("console"); // an answer to a request of before
  answer = new ApiError(0, "silent");
  who.refused();
  await who.check();
  expect(who.place).toBe("console");
  answer = NOBODY;
  who.refused();
  await who.check();
  expect(who.place).toBe("sign-in");
  expect(who.said).toContain("ann is signed in no longer");
  await who.check();
  expect(who.said).toContain("ann is signed in no longer"); // not lost by asking again
});

it("asks once for many refusals, and once more for what came meanwhile", async () => {
  const who = identity(ANN);
  await who.check();
  for (let n = 0; n < 50; n++) who.refused();
  await who.check();
  expect(asked).toBeLessThanOrEqual(3);
});

it("learns of another role by what is refused", async () => {
  const who = identity(as("operator"));
  await who.check();
  answer = as("viewer");
  who.failed(new ApiError(403, "ann is viewer here", [], "role"));
  await who.check();
  expect(who.operator).toEqual({ enabled: false, why: "Your role is viewer" });
});

it("signs out without a word, and stays where the server does not answer", async () => {
  const who = identity(ANN);
  await who.check();
  answer = NOBODY;
  await who.signOut();
  expect([who.place, who.said]).toEqual(["sign-in", null]);
});
