/// <reference types="node" />
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";

const tokens = readFileSync(new URL("../styles/tokens.css", import.meta.url), "utf8");

/** Relative luminance of "#rrggbb", by WCAG 2. */
function luminance(hex: string): number {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const value = parseInt(hex.slice(at, at + 2), 16) / 255;
    return value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

describe.each(["dark", "light"])("in the %s theme", (theme) => {
  const block = tokens.split(`[data-theme="${theme}"] {`)[1]?.split("}")[0] ?? "";
  const of = (name: string): string => new RegExp(`--${name}: (#[0-9a-f]{6});`).exec(block)?.[1] ?? "";

  it.each(["accent-fill", "accent-fill-hover", "danger-fill", "danger-fill-hover"])(
    "text on --%s can be read",
    (fill) => {
      const ratio = (luminance(of("on-fill")) + 0.05) / (luminance(of(fill)) + 0.05);
      expect(ratio).toBeGreaterThanOrEqual(4.5);
    },
  );
});
