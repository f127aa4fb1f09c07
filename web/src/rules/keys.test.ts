import { expect, it } from "vitest";
import contract from "../../../docs/openapi.json";
import { commandOfKey, opensWith, type Key } from "./keys";

const key = (name: string, more: Partial<Key> = {}): Key => ({
  key: name,
  repeat: false,
  focus: "none",
  modified: false,
  ...more,
});
const STATES: (string | null)[] = [...contract.components.schemas.State.enum, null];
const FOCUS = ["text", "control", "none"] as const;

it("Space holds what runs and gives no command in any other state", () => {
  for (const state of STATES) expect(commandOfKey(key(" "), state, false)).toBe(state === "running" ? "hold" : null);
});

it("no key sets a rig in motion", () => {
  const named = [" ", "Enter", "Home", "Escape", "r", "p", "ArrowRight"];
  const given = new Set(
    named.flatMap((name) =>
      STATES.flatMap((state) =>
        FOCUS.flatMap((focus) => [true, false].map((playback) => commandOfKey(key(name, { focus }), state, playback))),
      ),
    ),
  );
  expect(given).toEqual(new Set(["hold", "stop", "play", null]));
});

it("Space holds from a focused control too, which else keeps it", () => {
  expect(commandOfKey(key(" ", { focus: "control" }), "running", true)).toBe("hold");
  expect(commandOfKey(key(" ", { focus: "control" }), "armed", true)).toBeNull();
});

it("Space plays and pauses where there is a playback and nothing runs", () => {
  for (const state of STATES) expect(commandOfKey(key(" "), state, true)).toBe(state === "running" ? "hold" : "play");
});

it("Space is a space while text is typed, Esc stops even then", () => {
  expect(commandOfKey(key(" ", { focus: "text" }), "running", true)).toBeNull();
  expect(commandOfKey(key("Escape", { focus: "text" }), "running", false)).toBe("stop");
});

it("Esc stops in every state, known or not", () => {
  for (const state of STATES) expect(commandOfKey(key("Escape"), state, true)).toBe("stop");
});

it("a key held down counts once, a combination not at all", () => {
  expect(commandOfKey(key(" ", { repeat: true }), "running", false)).toBeNull();
  expect(commandOfKey(key(" ", { modified: true }), "running", false)).toBeNull();
  expect(commandOfKey(key("a"), "running", false)).toBeNull();
});

it("? and Ctrl-K open what they name, ? never while text is typed", () => {
  expect(opensWith(key("?"))).toBe("keys");
  expect(opensWith(key("?", { focus: "control" }))).toBe("keys");
  expect(opensWith(key("?", { focus: "text" }))).toBeNull();
  for (const focus of FOCUS) expect(opensWith(key("k", { focus, modified: true, ctrl: true }))).toBe("palette");
  expect(opensWith(key("k"))).toBeNull();
  expect(opensWith(key("k", { modified: true }))).toBeNull();
});
