import { expect, it } from "vitest";
import type { Snapshot } from "../contract/types";
import { NO_LINK, reduce, type Link } from "../net/link";
import { linkWarning, listsWarning, lost } from "./warning";

const SESSION = { state: "running" } as Snapshot;
const opened = reduce(reduce(NO_LINK, { type: "connecting" }), { type: "opened", session: SESSION });
const closed = reduce(opened, { type: "closed", reason: "gone" });

it("a page that just opened has lost nothing; a second attempt has", () => {
  const first: Link = reduce(NO_LINK, { type: "connecting" });
  expect([NO_LINK, first, opened].map(lost)).toEqual([false, false, false]);
  const failed = reduce(first, { type: "closed", reason: "refused" });
  expect([failed, reduce(failed, { type: "connecting" })].map(lost)).toEqual([true, true]);
  expect([closed, reduce(closed, { type: "connecting" })].map(lost)).toEqual([true, true]);
});

it("never says that Stop works where the connection is lost", () => {
  const text = linkWarning(closed, true, false) ?? "";
  expect(text).toContain("cannot reach the rig");
  expect(text).toContain("hardware E-stop");
  expect(text).not.toMatch(/work/);
  expect(linkWarning(closed, false, false)).toBe(text);
});

it("says by what Stop still goes where its channel is open", () => {
  expect(linkWarning(closed, true, true)).toMatch(/by their own channel, which is open/);
});

it("old data on an open connection disables motion, not Stop", () => {
  expect(linkWarning(opened, true, true)).toMatch(/Motion is disabled\. Stop and E-stop are sent/);
  expect(linkWarning(opened, false, true)).toBeNull();
});

it("lists that could not be read say what that means for Stop where no rig is known", () => {
  expect(listsWarning(null, false)).toBeNull();
  expect(listsWarning("The server does not answer", true)).toBe(
    "Not up to date: The server does not answer. Trying again.",
  );
  expect(listsWarning("The server does not answer", false)).toContain(
    "cannot be sent from here, use the hardware E-stop",
  );
});
