// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { useFakePage } from "#web/shared/testing_dom";
import type { Line } from "../chat";
import { ChatView } from "./chat_view";

const element = useFakePage();
let chat: ChatView;
let announced: string[];

const said = (name: string, text: string, mine = false): Line => ({
  kind: "said",
  number: 1,
  from: "p01",
  name,
  text,
  mine,
});

beforeEach(() => {
  announced = [];
  chat = new ChatView(
    () => "",
    (words) => announced.push(words),
  );
});

describe("the chat", () => {
  it("announces what is added while it is hidden", () => {
    chat.add(said("Bo", "hello"));
    chat.add(said("Ana", "hi", true));
    chat.add({ kind: "note", number: 2, text: "Chidi joined." });
    expect(announced).toEqual(["Bo: hello", "Chidi joined."]);
    expect(element("count-chat").textContent).toBe("1");
  });
  it("announces nothing while it is visible", () => {
    chat.seen(true);
    chat.add(said("Bo", "hello"));
    chat.add({ kind: "note", number: 2, text: "Chidi joined." });
    expect(announced).toEqual([]);
    chat.seen(false);
    chat.add(said("Bo", "bye"));
    expect(announced).toEqual(["Bo: bye"]);
  });
});
