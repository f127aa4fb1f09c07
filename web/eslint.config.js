import js from "@eslint/js";
import svelte from "eslint-plugin-svelte";
import { defineConfig, globalIgnores } from "eslint/config";
import globals from "globals";
import ts from "typescript-eslint";
import svelteConfig from "./svelte.config.js";

/** Who may import whom: each of these folders only those before it, and itself. */
const LAYERS = ["contract", "net", "rules", "state", "ui", "features"];

function below(layer, index) {
  const above = LAYERS.slice(index + 1);
  const regexes = [`^(\\.\\./)+(${[...above, "App|Console|main"].join("|")})(/|\\.|$)`];
  // One page knows nothing of another.
  if (layer === "features") regexes.push("^\\.\\./(?!\\.\\./)");
  const message = "contract < net < rules < state < ui < features; no feature imports another";
  const patterns = regexes.map((regex) => ({ regex, message }));
  return {
    files: [`src/${layer}/**`],
    rules: { "no-restricted-imports": ["error", { patterns }] },
  };
}

export default defineConfig(
  globalIgnores(["src/contract/schema.d.ts"]),
  { linterOptions: { reportUnusedDisableDirectives: "error" } },
  js.configs.recommended,
  { files: ["*.{js,ts}", "tools/**"], languageOptions: { globals: globals.node } },
  { files: ["*.ts"], extends: [ts.configs.recommended] },
  { files: ["public/**"], languageOptions: { globals: globals.browser } },
  {
    files: ["src/**/*.{ts,svelte}"],
    extends: [ts.configs.strictTypeChecked, svelte.configs.recommended, svelte.configs.prettier],
    languageOptions: {
      globals: globals.browser,
      parserOptions: { projectService: true, extraFileExtensions: [".svelte"] },
    },
    rules: {
      "@typescript-eslint/no-confusing-void-expression": ["error", { ignoreArrowShorthand: true }],
      // `void x` in an effect says what the effect depends on.
      "@typescript-eslint/no-meaningless-void-operator": "off",
      "@typescript-eslint/no-unused-vars": ["error", { varsIgnorePattern: "^_", argsIgnorePattern: "^_" }],
      "@typescript-eslint/restrict-template-expressions": ["error", { allowNumber: true }],
    },
  },
  {
    files: ["src/**/*.svelte", "src/**/*.svelte.ts"],
    languageOptions: { parserOptions: { parser: ts.parser, svelteConfig } },
  },
  ...LAYERS.map(below),
);
