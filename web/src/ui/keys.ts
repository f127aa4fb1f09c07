/** A key press of the page as the rules speak of it. */
import type { Key } from "../rules/keys";

const TEXT = "textarea, [contenteditable], input:is(:not([type]), [type='text'], [type='search'], [type='password'])";
/** A slider is none: Space does nothing to it. */
const CONTROL = "button, a, select, summary, input:not([type='range'])";

export function keyOf(event: KeyboardEvent): Key {
  const { target, key, repeat } = event;
  const within = (selector: string): boolean => target instanceof Element && target.closest(selector) !== null;
  const focus = within(TEXT) ? "text" : within(CONTROL) ? "control" : "none";
  const ctrl = (event.ctrlKey || event.metaKey) && !event.altKey;
  return { key, repeat, focus, modified: event.ctrlKey || event.altKey || event.metaKey, ctrl };
}
