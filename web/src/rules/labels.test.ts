import { expect, it } from "vitest";
import { withTags } from "./labels";

it.each([
  ["one more", ["north"], "south", ["north", "south"]],
  ["several, with blanks about them", [], " a b ,c,, ", ["a b", "c"]],
  ["one that is there, in other capitals", ["North"], "north, NORTH", ["North"]],
  ["nothing", ["north"], "  ", ["north"]],
])("%s", (_, tags, typed, all) => expect(withTags(tags, typed)).toEqual(all));
