import { expect, it } from "vitest";
import type { Api } from "./api";
import { ApiError } from "./errors";
import type { Listener } from "./stream";
import { watchedApi, watchedConnect, watchedLine } from "./watched";

const refusal = new ApiError(401, "sign in first", [], "sign-in");

function watch() {
  const told: unknown[] = [];
  return { told, failed: (error: unknown) => void told.push(error), refused: () => void told.push("refused") };
}

it("requests are asked as they are, and what fails is told once and to who asked too", async () => {
  const seen = watch();
  const asked = watchedApi(
    {
      rigs: () => Promise.reject(refusal),
      stop: (rig: string) => Promise.resolve(rig),
      streamUrl: (rig: string) => rig,
    } as never as Api,
    seen,
  );
  await expect(asked.rigs()).rejects.toBe(refusal);
  expect(await asked.stop("bench")).toBe("bench");
  expect(asked.streamUrl("bench")).toBe("bench");
  expect(seen.told).toEqual([refusal]);
});

it("streams and the stop channel tell that they were not let in", async () => {
  const seen = watch();
  watchedConnect((_, listener) => {
    listener.refused?.();
    return { close: () => undefined, control: () => undefined };
  }, seen)("ws://rig", {} as Listener);
  const line = watchedLine((_, refused) => {
    refused();
    return { press: () => Promise.reject(refusal), close: () => undefined };
  }, seen)(
    () => undefined,
    () => undefined,
  );
  await expect(line.press("stop", "bench")).rejects.toBe(refusal);
  expect(seen.told).toEqual(["refused", "refused", refusal]);
});
