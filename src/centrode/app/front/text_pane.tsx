// The text of the description, in an editor that is loaded when it is opened.
import { effect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { TextEditor } from "./editor";
import type { Completions } from "./protocol";
import { ask, editing, problems, takeTyped, text, typedBy, write } from "./state";
import { say, sentence, sentences } from "./words";

let typed = 0;
let last = 0;

export function TextPane() {
  const holder = useRef<HTMLDivElement>(null);
  useEffect(() => {
    let editor: TextEditor | null = null, gone = false, soon = 0;
    const stops: (() => void)[] = [];
    void import("./editor.js" as string).then((library: typeof import("./editor")) => {
      if (gone) return;
      editor = new library.TextEditor(holder.current!, text.value, {
        label: say("text"),
        changed: (value) => {
          const now = performance.now();
          clearTimeout(soon);
          const taken = (): void => {
            clearTimeout(soon);
            typedBy(() => undefined);
            write(value, typed > 0 && now - last < 1200);
            typed += 1;
            last = performance.now();
          };
          typedBy(taken);
          soon = window.setTimeout(taken, 180);
        },
        complete: async (value, line, column) => {
          const answer = await ask({ do: "complete", text: value, line, column }, "complete");
          return Array.isArray(answer?.options) ? (answer as Completions) : null;
        },
      });
      stops.push(effect(() => editor!.put(text.value)), effect(() => editor!.mark(problems.value.map((one) => ({ ...one, message: sentences(one.message, one.repair) })))));
    });
    return () => {
      gone = true;
      takeTyped();
      stops.forEach((stop) => stop());
      editor?.end();
    };
  }, []);
  return (
    <section class="card text-pane" aria-label={say("text")}>
      <div class="pane-head"><h2>{say("text")}</h2><button type="button" class="plain" aria-label={say("close")} title={say("close")} onClick={() => { editing.value = false; }}>×</button></div>
      <div class="editor" ref={holder} />
      {problems.value.length > 0 && (
        <ul class="problems">{problems.value.slice(0, 6).map((problem) => (
          <li><span class="bad">{problem.line ? `${say("line", { number: problem.line })}: ` : ""}{sentence(problem.message)}</span>{problem.repair ? ` ${sentence(problem.repair)}` : ""}</li>
        ))}</ul>
      )}
    </section>
  );
}
