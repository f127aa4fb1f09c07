// @vitest-environment happy-dom
import { beforeEach, expect, it, vi } from "vitest";
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
  const answers = { lease: (action: string) => (action === "take" ? held : givenLease(leaseOf("another"), "asked")) };
  const before = new TestConsole(answers).operate(session({ lease: leaseOf("another", { epoch: 4 }) }));
  await before.stores.operated.lease.take();
  before.stores.operated.close();
  const console = new TestConsole().operate(session({ lease: leaseOf("another", { epoch: 4 }) }));
  const { lease } = console.stores.operated;
  expect(lease.held).toBe(false);
  console.tell(session({ lease: ourLease({ epoch: 5, sequence: 2 }) }));
  expect(lease.held).toBe(true);
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

it("that another holds is asked for, and the person is told", async () => {
  const refused = new ApiError(409, "held by another");
  const console = new TestConsole({ lease: refused }).operate(session({ lease: leaseOf("another") }));
  await console.stores.operated.lease.take();
  expect(console.asked.map(([, , action]) => action)).toEqual(["take", "request"]);
  expect(console.stores.notices.all).toMatchObject([{ tone: "problem", text: "held by another" }]);
});
