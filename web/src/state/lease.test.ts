// @vitest-environment happy-dom
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Lease, Me } from "../contract/types";
import { ApiError } from "../net/errors";
import { TestConsole } from "../testing/console";
import { givenLease, leaseOf, ourLease, session } from "../testing/wire";

beforeEach(() => sessionStorage.clear());

it("is held by who took it, and renewed every two seconds for as long", async () => {
  vi.useFakeTimers();
  const console = new TestConsole({ lease: givenLease(ourLease()) });
  console.operate(session());
  const { lease } = console.stores.operated;
  await lease.take();
  expect(lease.held).toBe(false); // the stream has not said so yet
  console.tell(session({ lease: ourLease() }));
  expect(lease.held).toBe(true);
  vi.advanceTimersByTime(4000);
  expect(console.asked.filter(([, , action]) => action === "renew")).toEqual([
    ["lease", "bench", "renew", "a-secret"],
    ["lease", "bench", "renew", "a-secret"],
  ]);
  await lease.release();
  expect(console.asked.at(-1)).toEqual(["lease", "bench", "release", "a-secret"]);
  expect(lease.held).toBe(false);
  vi.advanceTimersByTime(4000);
  expect(console.asked.filter(([, , action]) => action === "renew")).toHaveLength(2);
  vi.useRealTimers();
});

it("is lost with its epoch, and not ours by our name alone", async () => {
  const console = new TestConsole({ lease: givenLease(ourLease()) }).operate(session({ lease: ourLease() }));
  const { lease } = console.stores.operated;
  await lease.take();
  console.tell(session({ lease: leaseOf("another", { epoch: 4 }) }));
  expect(lease.held).toBe(false);
  console.tell(session({ lease: ourLease({ epoch: 5, sequence: 2 }) }));
  expect(lease.held).toBe(false);
});

it("that was asked for is ours when it is granted, by the secret of the request, after a reload too", async () => {
  const held = new ApiError(409, "held by another");
  const asked = givenLease(leaseOf("another", { epoch: 4 }), "asked");
  const answers = { lease: (action: string) => (action === "take" ? held : asked) };
  const before = new TestConsole(answers).operate(session({ lease: leaseOf("another", { epoch: 4 }) }));
  await before.stores.operated.lease.take();
  before.stores.operated.close();
  const granted = ourLease({ epoch: 5, sequence: 2 });
  const console = new TestConsole({ lease: { ...granted, secret: null } });
  console.operate(session({ lease: leaseOf("another", { epoch: 4 }) }));
  const { lease } = console.stores.operated;
  expect(lease.held).toBe(false);
  console.tell(session({ lease: granted }));
  await expect.poll(() => lease.held).toBe(true);
  expect(console.asked).toEqual([["lease", "bench", "renew", "asked"]]);
  expect(lease.next()).toEqual({ epoch: 5, sequence: 3, secret: "asked" });
});

it("outlives a reload of the page, on its own rig alone", async () => {
  const before = new TestConsole({ lease: givenLease(ourLease()) }).operate(session({ lease: ourLease() }));
  await before.stores.operated.lease.take();
  before.stores.operated.close();
  const after = new TestConsole().operate(session({ lease: ourLease() }));
  expect(after.stores.operated.lease.held).toBe(true);
  expect(after.stores.operated.lease.next()).toEqual({ epoch: 3, sequence: 1, secret: "a-secret" });
  after.operate(session({ rig: "other" }));
  expect(after.stores.operated.lease.held).toBe(false);
});

it("is given up by a page that goes, and taken again by its reload, within moments", async () => {
  const before = new TestConsole({ lease: givenLease(ourLease()) }).operate(session({ lease: ourLease() }));
  await before.stores.operated.lease.take();
  before.stores.operated.lease.leave();
  expect(before.asked.at(-1)).toEqual(["leave", "bench", "a-secret"]);
  before.stores.operated.close();
  // Its word may not be there yet: then what was kept still holds.
  const after = new TestConsole({ lease: givenLease(ourLease({ epoch: 5 }), "another-secret") });
  after.operate(session({ lease: ourLease() }));
  expect(after.stores.operated.lease.held).toBe(true);
  after.tell(session({ lease: leaseOf(null, { epoch: 4 }) }));
  await expect.poll(() => after.asked).toEqual([["lease", "bench", "take"]]);
  after.tell(session({ lease: ourLease({ epoch: 5 }) }));
  await expect.poll(() => after.stores.operated.lease.held).toBe(true);
});

it("is not taken again where another has it meanwhile, nor long after", async () => {
  const before = new TestConsole({ lease: givenLease(ourLease()) }).operate(session({ lease: ourLease() }));
  await before.stores.operated.lease.take();
  before.stores.operated.lease.leave();
  before.stores.operated.close();
  const after = new TestConsole().operate(session({ lease: leaseOf("another", { epoch: 5 }) }));
  after.tell(session({ lease: leaseOf(null, { epoch: 6 }) }));
  expect(after.asked).toEqual([]);
  after.stores.operated.close();
  before.operate(session({ lease: ourLease() })).stores.operated.lease.leave();
  vi.useFakeTimers({ now: Date.now() + 60_000 });
  const late = new TestConsole().operate(session({ lease: leaseOf(null, { epoch: 4 }) }));
  expect(late.asked).toEqual([]);
  vi.useRealTimers();
});

it("that another holds is asked for, and the person is told", async () => {
  const refused = new ApiError(409, "held by another");
  const console = new TestConsole({ lease: refused }).operate(session({ lease: leaseOf("another") }));
  await console.stores.operated.lease.take();
  expect(console.asked.map(([, , action]) => action)).toEqual(["take", "request"]);
  expect(console.stores.notices.all).toMatchObject([{ tone: "problem", text: "held by another" }]);
});

const ANN: Me = {
  people: true,
  provider: null,
  person: { name: "ann", role: "operator", via: "session", until: null },
};

/** A window of a person who is signed in; each has a memory of its own, and this one's is empty. */
function windowOf(answers: object): TestConsole {
  sessionStorage.clear();
  const console = new TestConsole(answers);
  console.stores.identity.take(ANN);
  return console;
}

describe("of a person with two windows", () => {
  const theirs = (given: Partial<Lease> = {}): Lease => leaseOf("ann", { epoch: 4, ...given });
  const refused = new ApiError(403, "the lease is ann's in epoch 5, and this is not its secret");

  it("the lease is the one's that has its secret, though the name is both's", () => {
    const console = windowOf({}).operate(session({ lease: theirs() }));
    expect(console.stores.operated.lease.held).toBe(false);
    expect(console.asked).toEqual([]);
  });

  it("one that has asked the other for it has it once it is granted, and not before", async () => {
    const answers: Record<string, unknown> = {
      take: new ApiError(409, "ann holds the lease"),
      request: givenLease(theirs(), "asked"),
      renew: { ...theirs({ epoch: 5 }), secret: null },
    };
    const console = windowOf({ lease: (action: string) => answers[action] }).operate(session({ lease: theirs() }));
    const { lease } = console.stores.operated;
    await lease.take();
    console.tell(session({ lease: theirs({ requested_by: ["ann"] }) }));
    expect([lease.held, lease.asking]).toEqual([false, true]);
    expect(console.stores.notices.all).toMatchObject([
      { text: "Another window of yours has control, and was asked for it." },
    ]);
    console.tell(session({ lease: theirs({ epoch: 5 }) }));
    await expect.poll(() => lease.held).toBe(true);
    expect(lease.next()).toEqual({ epoch: 5, sequence: 1, secret: "asked" });
  });

  it("one whose request was not the one that was granted has nothing", async () => {
    const answers: Record<string, unknown> = {
      take: new ApiError(409, "ann holds the lease"),
      request: givenLease(theirs(), "asked"),
      renew: refused,
    };
    const console = windowOf({ lease: (action: string) => answers[action] }).operate(session({ lease: theirs() }));
    const { lease } = console.stores.operated;
    await lease.take();
    console.tell(session({ lease: theirs({ epoch: 5 }) }));
    await expect.poll(() => console.asked.at(-1)).toEqual(["lease", "bench", "renew", "asked"]);
    await expect.poll(() => lease.asking).toBe(false);
    console.tell(session({ lease: theirs({ epoch: 5 }) }));
    expect(lease.held).toBe(false);
    expect(console.asked.filter(([, , action]) => action === "renew")).toHaveLength(1);
  });

  it("one whose secret is refused gives it up: the epoch was another process's", async () => {
    const answers: Record<string, unknown> = { take: givenLease(theirs()), renew: refused };
    const console = windowOf({ lease: (action: string) => answers[action] }).operate(session({ lease: theirs() }));
    const { lease } = console.stores.operated;
    await lease.take();
    expect(lease.held).toBe(true);
    await lease.renew();
    expect(lease.held).toBe(false);
  });
});

it("is given up on every rig by who signs out, and is nobody else's in this tab", async () => {
  const console = windowOf({ lease: givenLease(leaseOf("ann")) }).operate(
    session({ rig: "other", lease: leaseOf("ann") }),
  );
  await console.stores.operated.lease.take();
  console.operate(session({ lease: leaseOf("ann") }));
  await console.stores.operated.lease.take();
  expect(console.stores.operated.lease.held).toBe(true);
  const next = new TestConsole({ lease: givenLease(leaseOf("bob")) });
  next.stores.identity.take({ ...ANN, person: { name: "bob", role: "operator", via: "session", until: null } });
  expect(next.operate(session({ lease: leaseOf("bob") })).stores.operated.lease.held).toBe(false);
  await console.stores.operated.lease.giveUp();
  const released = console.asked.filter(([, , action]) => action === "release").map(([, rig]) => rig);
  expect(released.sort()).toEqual(["bench", "other"]);
  expect(console.stores.operated.lease.held).toBe(false);
});
