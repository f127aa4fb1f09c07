import { expect, it } from "vitest";
import { commandOfKey, type Key } from "./keys";

const key = (name: string, more: Partial<Key> = {}): Key => ({ key: name, repeat: false, typing: false, modified: false, ...more });

it("Space holds what runs and resumes what is held, and nothing else", () => {
  expect(commandOfKey(key(" "), "running")).toBe("hold");
  expect(commandOfKey(key(" "), "held")).toBe("resume");
  for (const state of ["armed", "positioning", "stopping", "estopped", null]) expect(commandOfKey(key(" "), state)).toBeNull();
});

it("Space is a space while typing, Esc stops even then", () => {
  expect(commandOfKey(key(" ", { typing: true }), "running")).toBeNull();
  expect(commandOfKey(key("Escape", { typing: true }), "running")).toBe("stop");
});

it("Esc stops in every state, known or not", () => {
  for (const state of ["running", "held", "idle", null]) expect(commandOfKey(key("Escape"), state)).toBe("stop");
});

it("a key held down counts once, a combination not at all", () => {
  expect(commandOfKey(key(" ", { repeat: true }), "held")).toBeNull();
  expect(commandOfKey(key(" ", { modified: true }), "held")).toBeNull();
  expect(commandOfKey(key("a"), "running")).toBeNull();
});
