// @vitest-environment happy-dom
import { beforeEach, expect, it } from "vitest";
import { alarm } from "../testing/wire";
import { Alerts, type Signals } from "./alerts.svelte";

let said: string[];
const signals: Signals = {
  sound: () => void said.push("sound"),
  permit: () => {
    said.push("permit");
    return Promise.resolve(true);
  },
  notify: (title, text) => void said.push(`${title}: ${text}`),
};

beforeEach(() => {
  localStorage.clear();
  said = [];
});

it("is chosen once and kept", async () => {
  const alerts = new Alerts(signals);
  expect(alerts.on).toBeNull();
  await alerts.choose(true);
  expect(said).toEqual(["sound", "permit"]);
  expect(new Alerts(signals).on).toBe(true);
  await alerts.choose(false);
  expect(new Alerts(signals).on).toBe(false);
});

it("is heard for what is new, once, and shown where the page is not in sight", async () => {
  const alerts = new Alerts(signals);
  await alerts.choose(true);
  said = [];
  alerts.observe("bench", [alarm({ number: 1 })], true); // stood before: no news
  expect(said).toEqual([]);
  alerts.observe("bench", [alarm({ number: 1 }), alarm({ number: 2, message: "too fast" })], false);
  alerts.observe("bench", [alarm({ number: 1 }), alarm({ number: 2, message: "too fast" })], false);
  expect(said).toEqual(["sound"]);
  alerts.observe("bench", [alarm({ number: 2, count: 2, message: "too fast" })], true);
  expect(said.slice(1)).toEqual(["sound", "bench: 1 alarm: too fast"]);
  alerts.anew();
  alerts.observe("other", [alarm({ number: 9 })], true);
  expect(said).toHaveLength(3);
});

it("is silent until it is chosen", () => {
  const alerts = new Alerts(signals);
  alerts.observe("bench", [], true);
  alerts.observe("bench", [alarm()], true);
  expect(said).toEqual([]);
});
