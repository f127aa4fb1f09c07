/** Lists that are read a page at a time, the newest rows first. */

import type { Page } from "../net/request";

type KeyOf<Row> = (row: Row) => string;

export const NOTHING: Page<never> = { rows: [], next: null };

/** What is known once the newest page was read again: it, and what was read of the pages after it. */
export function renewed<Row>(newest: Page<Row>, known: Page<Row>, keyOf: KeyOf<Row>): Page<Row> {
  const last = newest.rows.at(-1);
  if (newest.next === null || last === undefined) return newest;
  const place = known.rows.findIndex((row) => keyOf(row) === keyOf(last));
  // Where the two do not meet, there may be rows between them.
  if (place < 0 || place === known.rows.length - 1) return newest;
  return { rows: [...newest.rows, ...known.rows.slice(place + 1)], next: known.next };
}

/** What is known once the page after it was read. */
export function extended<Row>(known: Page<Row>, older: Page<Row>, keyOf: KeyOf<Row>): Page<Row> {
  const there = new Set(known.rows.map(keyOf));
  return { rows: [...known.rows, ...older.rows.filter((row) => !there.has(keyOf(row)))], next: older.next };
}
