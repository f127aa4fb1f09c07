import { expect, it } from "vitest";

const sources = import.meta.glob<string>(["../**/*.{ts,svelte}", "!../**/*.test.ts", "!../contract/schema.d.ts"], {
  query: "?raw",
  import: "default",
  eager: true,
});

it("no dialog of the browser or of the page stands between a person and Stop", () => {
  expect(Object.keys(sources).length).toBeGreaterThan(50);
  // A page with a browser's dialog runs no timer: the lease falls silent, and the rig is held.
  const modal = /\b(alert|confirm|prompt|showModal)\s*\(/;
  expect(Object.entries(sources).flatMap(([path, text]) => (modal.test(text) ? [path] : []))).toEqual([]);
});
