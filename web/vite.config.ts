import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig, type Plugin } from "vite";

// The API and the scene of a development run; a built console is served by the server itself, on its own port.
const server = process.env["FULLPOSE_SERVER"] ?? "http://127.0.0.1:8642";

/** What the API's page is drawn by: FastAPI takes it from the network, where a laboratory may have none. */
function apiPage(): Plugin {
  const files = createRequire(import.meta.url);
  return {
    name: "api-page",
    apply: "build",
    generateBundle() {
      for (const name of ["swagger-ui-bundle.js", "swagger-ui.css"]) {
        const source = readFileSync(files.resolve(`swagger-ui-dist/${name}`));
        this.emitFile({ type: "asset", fileName: `assets/api/${name}`, source });
      }
    },
  };
}

export default defineConfig({
  plugins: [svelte(), apiPage()],
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
