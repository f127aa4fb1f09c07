/** Tags that people put to flights, plans and runs. What one may be is the server's to say. */

/** Those and the ones that were typed, of which there may be several, with commas; each once, whatever its capitals. */
export function withTags(tags: readonly string[], typed: string): string[] {
  const all = [...tags];
  for (const tag of typed.split(",").map((each) => each.trim())) {
    const known = all.some((each) => each.toLowerCase() === tag.toLowerCase());
    if (tag !== "" && !known) all.push(tag);
  }
  return all;
}
