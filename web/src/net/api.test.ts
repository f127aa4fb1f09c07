import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { api } from "./api";

const limits: number[] = [];

beforeEach(() => {
  limits.length = 0;
  vi.stubGlobal("sessionStorage", { getItem: () => "console-test" });
  // A server that never answers, and a clock that is already at the end of every limit.
  vi.spyOn(AbortSignal, "timeout").mockImplementation((ms) => {
    limits.push(ms);
    return AbortSignal.abort(new DOMException("late", "TimeoutError"));
  });
  vi.stubGlobal("fetch", (_: string, { signal }: RequestInit) => Promise.reject(signal?.reason as DOMException));
});

afterEach(() => {
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});

it.each([
  ["stop", 2, () => api.stop("rig")],
  ["estop", 2, () => api.estop("rig")],
  ["a command", 10, () => api.command("rig", "hold", {}, null)],
  ["the lease", 10, () => api.lease("rig", "renew", "secret")],
  ["the lease, which may have to start a process", 180, () => api.lease("rig", "take")],
  ["what is read", 60, () => api.plans()],
])("%s waits %d s for an answer, and says that none came", async (_, seconds, send) => {
  await expect(send()).rejects.toMatchObject({ status: 0, message: `The server did not answer within ${seconds} s` });
  expect(limits).toEqual([1000 * seconds]);
});
