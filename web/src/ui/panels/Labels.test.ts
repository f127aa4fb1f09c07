// @vitest-environment happy-dom
import { fireEvent, screen } from "@testing-library/svelte";
import { expect, it, vi } from "vitest";
import type { Me } from "../../contract/types";
import { TestConsole } from "../../testing/console";
import Labels from "./Labels.svelte";

const VIEWER: Me = {
  people: true,
  person: { name: "vic", role: "viewer", via: "session", until: null },
  provider: null,
};

async function shown(put = vi.fn(() => Promise.resolve()), me?: Me) {
  const console = new TestConsole(me ? { me } : {});
  if (me) await console.stores.identity.check();
  const find = vi.fn();
  console.show(Labels, { of: "the flight loop", tags: ["north", "2026"], notes: "As flown.", put, find });
  return { put, find, console };
}

it("a tag is added by Enter, several with commas, and the field is free for the next", async () => {
  const { put } = await shown();
  const field = screen.getByRole<HTMLInputElement>("textbox", { name: "Add a tag" });
  await fireEvent.input(field, { target: { value: "wind, North" } });
  await fireEvent.submit(field);
  await expect.poll(() => field.value).toBe("");
  expect(put).toHaveBeenCalledExactlyOnceWith({ tags: ["north", "2026", "wind"] });
});

it("a tag finds what else has it, and is taken away", async () => {
  const { put, find } = await shown();
  await fireEvent.click(screen.getByRole("button", { name: "north" }));
  expect(find).toHaveBeenCalledExactlyOnceWith("north");
  await fireEvent.click(screen.getByRole("button", { name: "Remove the tag north" }));
  expect(put).toHaveBeenCalledExactlyOnceWith({ tags: ["2026"] });
});

it("notes are written where they stand", async () => {
  const { put } = await shown();
  await fireEvent.click(screen.getByRole("button", { name: "Edit the notes" }));
  const area = screen.getByRole<HTMLTextAreaElement>("textbox", { name: "Notes" });
  expect(area.value).toBe("As flown.");
  await fireEvent.input(area, { target: { value: "Twice." } });
  await fireEvent.click(screen.getByRole("button", { name: "Save" }));
  await expect.poll(() => screen.queryByRole("textbox", { name: "Notes" })).toBeNull();
  expect(put).toHaveBeenCalledExactlyOnceWith({ notes: "Twice." });
});

it("what is refused is said, and what was typed stays", async () => {
  const { console } = await shown(vi.fn(() => Promise.reject(new Error("tag of 41 characters"))));
  const field = screen.getByRole<HTMLInputElement>("textbox", { name: "Add a tag" });
  await fireEvent.input(field, { target: { value: "wind" } });
  await fireEvent.submit(field);
  await expect.poll(() => console.stores.notices.all).toMatchObject([{ text: "tag of 41 characters" }]);
  expect(field.value).toBe("wind");
});

it("a viewer sees them, and changes none", async () => {
  await shown(undefined, VIEWER);
  expect(screen.getByText("As flown.")).toBeTruthy();
  expect(screen.queryByRole("button", { name: /Remove/ })).toBeNull();
  expect(screen.getByRole<HTMLInputElement>("textbox", { name: "Add a tag" }).disabled).toBe(true);
  expect(screen.getByRole<HTMLButtonElement>("button", { name: "Edit the notes" }).disabled).toBe(true);
});
