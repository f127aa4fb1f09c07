import { expect, it } from "vitest";
import { refusalOf, sendingText, takesFlights } from "./drop";
import { PAGES } from "./router";

const file = (name: string, size = 10): { name: string; size: number } => ({ name, size });

it("operate and flights take a flight, no other page does", () => {
  expect(PAGES.filter(takesFlights)).toEqual(["operate", "trajectories"]);
});

it("what is not taken is said", () => {
  expect(refusalOf([file("a.csv")], null, 100)).toBeNull();
  expect(refusalOf([], null, 100)).toContain("no file");
  expect(refusalOf([file("a.csv"), file("b.csv")], null, 100)).toContain("2 files at once, one is expected");
  expect(refusalOf([file("a.csv")], "b.csv", 100)).toBe("a.csv was not taken: b.csv is still being sent");
  expect(refusalOf([file("a.csv", 3e6)], null, 2e6)).toBe("a.csv has 3 MB, the server takes 2 MB");
});

it("what has been sent is still being checked", () => {
  expect(sendingText(0.999)).toBe("99 % sent");
  expect(sendingText(1)).toBe("Sent, checking…");
});
