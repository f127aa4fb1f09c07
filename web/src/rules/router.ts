/** Paths of the pages: /operate/{rig}, /trajectories/{sha}, /plans/{id}, /compare/{id}, /runs/{id}, and the others alone. */

export const PAGES = [
  "operate",
  "trajectories",
  "plans",
  "compare",
  "runs",
  "alarms",
  "rigs",
  "people",
  "account",
] as const;
export type Page = (typeof PAGES)[number];

export interface Route {
  page: Page;
  /** What the page shows: a rig, a trajectory, a plan, a comparison, a run; null for none named. */
  item: string | null;
}

/** An unknown path is the operate page: a console never greets an operator with "not found". */
export function routeOf(path: string): Route {
  const [page, item] = path.split("/").filter((part) => part !== "");
  const known = PAGES.find((name) => name === page) ?? "operate";
  return { page: known, item: known === page && item ? decodeURIComponent(item) : null };
}

export function pathOf(page: Page, item?: string | null): string {
  return item ? `/${page}/${encodeURIComponent(item)}` : `/${page}`;
}
