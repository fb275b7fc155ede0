// CodeMirror with TOML: kept apart, since most who draw never open the text.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { HighlightStyle, StreamLanguage, bracketMatching, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { type Diagnostic, lintGutter, setDiagnostics } from "@codemirror/lint";
import { Annotation, EditorState, Text } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { Completions, Problem } from "./protocol";

const OUTSIDE = Annotation.define<boolean>(); // a change that did not come from the keyboard

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--muted)", fontStyle: "italic" },
  { tag: [tags.string, tags.special(tags.string)], color: "var(--good)" },
  { tag: [tags.number, tags.bool, tags.atom], color: "var(--link)" },
  { tag: [tags.propertyName, tags.definition(tags.variableName), tags.variableName], color: "var(--ink)" },
]);
const look = EditorView.theme({
  "&": { color: "var(--ink)", backgroundColor: "var(--paper)", fontSize: "0.875rem", height: "100%" },
  "&.cm-focused": { outline: "none" },
  ".cm-scroller": { fontFamily: 'ui-monospace, "DejaVu Sans Mono", "Liberation Mono", monospace', lineHeight: "1.5" },
  ".cm-gutters": { backgroundColor: "var(--paper)", color: "var(--muted)", border: "none" },
  ".cm-activeLine": { backgroundColor: "color-mix(in srgb, var(--link) 6%, transparent)" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  ".cm-selectionBackground, &.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground": { backgroundColor: "color-mix(in srgb, var(--link) 22%, transparent)" },
  ".cm-tooltip": { backgroundColor: "var(--paper)", color: "var(--ink)", border: "1px solid var(--line)", borderRadius: "4px" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--link)", color: "var(--paper)" },
  ".cm-diagnostic": { borderLeftColor: "var(--bad)", padding: "4px 8px" },
});

export interface EditorHost {
  label: string;
  changed: (text: string) => void;
  complete: (text: string, line: number, column: number) => Promise<Completions | null>;
}

export class TextEditor {
  private readonly view: EditorView;

  constructor(parent: HTMLElement, text: string, private readonly host: EditorHost) {
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        doc: text,
        extensions: [
          lineNumbers(), history(), drawSelection(), bracketMatching(), closeBrackets(), highlightActiveLine(), lintGutter(),
          StreamLanguage.define(toml), syntaxHighlighting(colours), look, EditorView.lineWrapping,
          ...(text.includes("\r\n") ? [EditorState.lineSeparator.of("\r\n")] : []), // ends of lines stay as the file has them
          EditorView.contentAttributes.of({ "aria-label": host.label, tabindex: "0" }),
          autocompletion({ override: [(context) => this.complete(context)] }),
          keymap.of([...closeBracketsKeymap, ...completionKeymap, ...historyKeymap, ...defaultKeymap, indentWithTab]),
          EditorView.updateListener.of((update) => {
            if (update.docChanged && !update.transactions.some((one) => one.annotation(OUTSIDE))) host.changed(update.state.sliceDoc());
          }),
        ],
      }),
    });
  }

  // Takes over a text from the drawing, changing only what differs, so that the cursor stays.
  put(text: string): void {
    if (this.view.state.sliceDoc() === text) return;
    const now = this.view.state.doc.toString(); // with one letter for the end of a line, as places in it count
    text = text.replaceAll("\r\n", "\n");
    let begin = 0, end = 0;
    const most = Math.min(now.length, text.length);
    while (begin < most && now[begin] === text[begin]) begin += 1;
    while (end < most - begin && now[now.length - 1 - end] === text[text.length - 1 - end]) end += 1;
    this.view.dispatch({ changes: { from: begin, to: now.length - end, insert: Text.of(text.slice(begin, text.length - end).split("\n")) }, annotations: OUTSIDE.of(true) });
  }

  mark(problems: Problem[]): void {
    const { doc } = this.view.state;
    const found: Diagnostic[] = problems.map((problem) => {
      const line = doc.line(Math.min(doc.lines, Math.max(1, problem.line ?? 1)));
      const from = Math.min(line.to, line.from + Math.max(0, (problem.column ?? 1) - 1));
      return { from, to: Math.max(from, line.to), severity: "error", message: problem.message };
    });
    this.view.dispatch(setDiagnostics(this.view.state, found));
  }

  private async complete(context: CompletionContext): Promise<CompletionResult | null> {
    const word = context.matchBefore(/[\w\-"[]*/);
    if (!context.explicit && (!word || word.from === word.to)) return null;
    const line = context.state.doc.lineAt(context.pos);
    const found = await this.host.complete(context.state.sliceDoc(), line.number, context.pos - line.from + 1);
    if (!found?.options.length) return null;
    const types: Record<string, string> = { key: "property", heading: "namespace", name: "variable", word: "enum" };
    return { from: line.from + found.from - 1, options: found.options.map((one) => ({ label: one.label, detail: one.detail, type: types[one.type ?? ""] })), validFor: /^[\w.\-"[\]]*$/ };
  }

  end(): void {
    this.view.destroy();
  }
}
