/** Light or dark: the system's choice until the person makes one. */
type Theme = "light" | "dark";

const KEY = "fullpose.theme";

export class ThemeChoice {
  current: Theme = $state("dark");

  constructor() {
    const system = matchMedia("(prefers-color-scheme: dark)");
    const fromSystem = (): Theme => (system.matches ? "dark" : "light");
    const chosen = localStorage.getItem(KEY);
    this.#show(chosen === "light" || chosen === "dark" ? chosen : fromSystem());
    system.addEventListener("change", () => {
      if (localStorage.getItem(KEY) === null) this.#show(fromSystem());
    });
  }

  toggle(): void {
    const next = this.current === "dark" ? "light" : "dark";
    localStorage.setItem(KEY, next);
    this.#show(next);
  }

  #show(theme: Theme): void {
    this.current = theme;
    document.documentElement.dataset["theme"] = theme;
  }
}
