// @vitest-environment happy-dom
import { fireEvent, render, screen } from "@testing-library/svelte";
import { createRawSnippet } from "svelte";
import { describe, expect, it, vi } from "vitest";
import { TestConsole } from "../../testing/console";
import Button from "./Button.svelte";
import Confirm from "./Confirm.svelte";
import Dialog from "./Dialog.svelte";
import FrameSwatch from "./FrameSwatch.svelte";
import List from "./List.svelte";
import Toaster from "./Toaster.svelte";
import ToggleGroup from "./ToggleGroup.svelte";

const text = (said: string) => createRawSnippet(() => ({ render: () => `<span>${said}</span>` }));
const button = (name: string | RegExp): HTMLButtonElement => screen.getByRole("button", { name });

/** A button of the page behind, as Stop is. */
function behind(): { pressed: () => void; element: HTMLButtonElement } {
  const pressed = vi.fn();
  const element = document.body.appendChild(document.createElement("button"));
  element.textContent = "Stop";
  element.onclick = pressed;
  return { pressed, element };
}

describe("a button", () => {
  it("that may not be pressed says why, and does nothing", async () => {
    const onclick = vi.fn();
    render(Button, { may: { enabled: false, why: "Take control first" }, onclick, children: text("Arm") });
    expect(button("Arm")).toMatchObject({ disabled: true, title: "Take control first" });
    await fireEvent.click(button("Arm"));
    expect(onclick).not.toHaveBeenCalled();
  });

  it("that may be pressed has its own title, and sends no form unless it is to", () => {
    render(Button, { may: { enabled: true }, title: "Arms the drives", kind: "main", children: text("Arm") });
    expect(button("Arm")).toMatchObject({ disabled: false, title: "Arms the drives", type: "button" });
    expect([...button("Arm").classList]).toEqual(["button", "main"]);
  });
});

describe("a toggle group", () => {
  const options = [
    { value: "alarms", label: "Alarms", badge: 2 },
    { value: "process", label: "Rig process", badge: 0 },
  ];

  it("has one pressed, and follows the person", async () => {
    render(ToggleGroup, { label: "Shown", options, value: "alarms", look: "tabs" });
    const pressed = (): (string | null)[] =>
      screen.getAllByRole("button").map((each) => each.getAttribute("aria-pressed"));
    expect(pressed()).toEqual(["true", "false"]);
    await fireEvent.click(button("Rig process"));
    expect(pressed()).toEqual(["false", "true"]);
  });

  it("shows what waits, and nothing where nothing does", () => {
    render(ToggleGroup, { label: "Shown", options, value: "alarms", look: "tabs" });
    expect(screen.getByRole("group", { name: "Shown" }).querySelectorAll(".badge")).toHaveLength(1);
    expect(button(/Alarms/).textContent).toContain("2");
  });
});

describe("a dialog", () => {
  const props = { title: "Move the frames", width: 400, closable: true, children: text("Where to?") };

  it("is never modal: what is behind it can be pressed, and reached by the keyboard", async () => {
    const { pressed, element } = behind();
    render(Dialog, { ...props, close: () => undefined });
    const dialog = screen.getByRole("dialog", { name: "Move the frames" });
    expect(dialog.getAttribute("aria-modal")).toBeNull();
    expect(document.querySelectorAll("[inert], [aria-hidden='true']:not(svg)")).toHaveLength(0);
    element.focus();
    expect(document.activeElement).toBe(element);
    await fireEvent.click(element);
    expect(pressed).toHaveBeenCalledOnce();
    element.remove();
  });

  it("closes by its button and by Esc, which it leaves to the page as well", async () => {
    const close = vi.fn();
    const heard = vi.fn();
    window.addEventListener("keydown", heard);
    render(Dialog, { ...props, close });
    await fireEvent.click(button("Close"));
    await fireEvent.keyDown(screen.getByRole("dialog"), { key: "Escape" });
    expect(close).toHaveBeenCalledTimes(2);
    expect(heard).toHaveBeenCalledOnce();
    window.removeEventListener("keydown", heard);
  });

  it("gives the focus back, but takes it from nobody", () => {
    const { element } = behind();
    element.focus();
    const first = render(Dialog, { ...props, close: () => undefined });
    button("Close").focus();
    first.unmount();
    expect(document.activeElement).toBe(element);

    const other = document.body.appendChild(document.createElement("input"));
    const second = render(Dialog, { ...props, close: () => undefined });
    other.focus();
    second.unmount();
    expect(document.activeElement).toBe(other);
    element.remove();
    other.remove();
  });
});

describe("a question", () => {
  const question = (said: string[]) => ({
    title: "Delete it?",
    action: "Delete",
    confirmed: () => said.push("confirmed"),
    close: () => said.push("closed"),
    children: text("It is gone then."),
  });

  it("waits on Cancel: Enter does no harm", async () => {
    const said: string[] = [];
    render(Confirm, question(said));
    expect(document.activeElement).toBe(button("Cancel"));
    await fireEvent.click(button("Cancel"));
    expect(said).toEqual(["closed"]);
  });

  it("goes on where it is told to", async () => {
    const said: string[] = [];
    render(Confirm, question(said));
    await fireEvent.click(button("Delete"));
    expect(said).toEqual(["confirmed", "closed"]);
  });
});

it("a list marks what is shown, and tells what was chosen", async () => {
  const show = vi.fn();
  const entry = { about: "plan on bench", when: "today" };
  const entries = [
    { id: "a", title: "loop", tag: { tone: "good", word: "Flyable" }, ...entry },
    { id: "b", title: "roll", ...entry },
  ];
  render(List, { label: "Plans", entries, shown: "a", show });
  expect(button(/loop/).getAttribute("aria-current")).toBe("true");
  expect(button(/loop/).textContent).toContain("Flyable");
  expect(button(/roll/).getAttribute("aria-current")).toBe("false");
  await fireEvent.click(button(/roll/));
  expect(show).toHaveBeenCalledExactlyOnceWith("b");
});

it("a frame is shown by its name and the colour it has everywhere", () => {
  const { container } = render(FrameSwatch, { frame: "inner" });
  expect(container.textContent).toBe("inner");
  expect(container.querySelector("i")?.getAttribute("style")).toContain("var(--frame-inner)");
});

describe("the toaster", () => {
  it("alerts of a problem, tells the rest, and puts away what is dismissed", async () => {
    const console = new TestConsole();
    console.show(Toaster, {});
    console.stores.notices.say("problem", "no memory");
    console.stores.notices.say("info", "asked for control");
    expect((await screen.findByRole("alert")).textContent).toContain("no memory");
    expect(screen.getByRole("status").textContent).toContain("asked for control");
    await fireEvent.click(screen.getAllByRole("button", { name: "Dismiss" })[0] as HTMLElement);
    expect(screen.queryByRole("alert")).toBeNull();
  });

  it("says a thing once, keeps the newest four, and lets them go by themselves", () => {
    vi.useFakeTimers();
    const { notices } = new TestConsole().stores;
    for (const said of ["a", "b", "c", "d", "e", "c"]) notices.say("info", said);
    notices.say("problem", "e");
    expect(notices.all.map((notice) => notice.text)).toEqual(["b", "d", "c", "e"]);
    vi.advanceTimersByTime(5000);
    expect(notices.all.map((notice) => notice.text)).toEqual(["e"]);
    vi.advanceTimersByTime(7000);
    expect(notices.all).toEqual([]);
    vi.useRealTimers();
  });
});
