/** Where the console is; the browser's history is the source. */
import { pathOf, routeOf, type Page } from "../rules/router";

const BACK = "fullpose.back";

export class Router {
  route = $state.raw(routeOf(location.pathname));

  constructor() {
    window.addEventListener("popstate", () => (this.route = routeOf(location.pathname)));
  }

  /** What a page shows; null where another page is open, whose item is none of its own. */
  item(page: Page): string | null {
    return this.route.page === page ? this.route.item : null;
  }

  /** Keeps where the console is over a way through another site, that ends at "/". */
  keep(): void {
    sessionStorage.setItem(BACK, location.pathname);
  }

  /** Goes on where the console was before such a way. */
  comeBack(): void {
    const kept = sessionStorage.getItem(BACK);
    sessionStorage.removeItem(BACK);
    if (kept === null || location.pathname !== "/") return;
    const { page, item } = routeOf(kept);
    this.go(page, item);
  }

  go(page: Page, item?: string | null): void {
    const path = pathOf(page, item);
    if (path !== location.pathname) history.pushState(null, "", path);
    this.route = routeOf(path);
  }
}
