import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vite";

// The API and the scene of a development run; a built console is served by the server itself, on its own port.
const server = process.env["FULLPOSE_SERVER"] ?? "http://127.0.0.1:8642";

export default defineConfig({
  plugins: [svelte()],
  base: "/",
  build: {
    outDir: process.env["FULLPOSE_CONSOLE_OUT"] ?? "../server/fullpose_server/console",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0, // a font as a data: URL would be refused by a strict content policy
  },
  server: {
    proxy: {
      "/api": { target: server, ws: true },
      "/scene": { target: server, ws: true },
    },
  },
});
