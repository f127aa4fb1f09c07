// @vitest-environment happy-dom
import { expect, it } from "vitest";
import { keyOf } from "./keys";

it.each([
  ["<input type='password'>", "text"],
  ["<input>", "text"],
  ["<textarea></textarea>", "text"],
  ["<input type='number'>", "control"],
  ["<input type='range'>", "none"],
  ["<button></button>", "control"],
  ["<div></div>", "none"],
])("a key on %s is on %s", (html, focus) => {
  const place = document.createElement("div");
  place.innerHTML = html;
  let seen: ReturnType<typeof keyOf> | undefined;
  place.addEventListener("keydown", (event) => (seen = keyOf(event)));
  place.firstElementChild?.dispatchEvent(new KeyboardEvent("keydown", { key: " ", bubbles: true }));
  expect(seen).toMatchObject({ key: " ", focus });
});
