import { svelte } from "@sveltejs/vite-plugin-svelte";
import { svelteTesting } from "@testing-library/svelte/vite";
import { defineConfig } from "vitest/config";

// A component's test asks for a document of its own: `@vitest-environment happy-dom` in its first line.
export default defineConfig({
  plugins: [svelte(), svelteTesting()],
  // In threads that are not made anew for every file: the tests take a third of the processor's time, and share no state.
  test: { include: ["src/**/*.test.ts"], environment: "node", passWithNoTests: false, pool: "threads", isolate: false },
});
