// Undo and redo are texts: what was, is there again byte by byte.

// The file that a text belongs to, with the text that it holds on disk: known from opening or saving it.
export interface TextFile {
  name: string | null;
  saved: string | null;
}
interface Step {
  text: string;
  file: TextFile;
}
// A step in a store: its text, with the name of its file where that is another one than the present one.
export type KeptStep = string | { text: string; name: string | null };

export class History {
  private before: Step[] = [];
  private after: Step[] = [];

  constructor(public text: string, public file: TextFile = { name: null, saved: null }) {}

  get undoes(): boolean {
    return this.before.length > 0;
  }
  get redoes(): boolean {
    return this.after.length > 0;
  }
  private get step(): Step {
    return { text: this.text, file: this.file };
  }

  // A new text; `merge` replaces the last one, as letters that are typed behind one another are one step.
  put(text: string, merge = false, file = this.file): void {
    if (text !== this.text) {
      if (!(merge && this.before.length)) this.before.push(this.step);
      this.after = [];
      this.text = text;
    }
    this.file = file;
  }

  undo(): string | null {
    return this.travel(this.before, this.after);
  }

  redo(): string | null {
    return this.travel(this.after, this.before);
  }

  private travel(from: Step[], to: Step[]): string | null {
    const step = from.pop();
    if (step === undefined) return null;
    to.push(this.step);
    this.file = step.file;
    return (this.text = step.text);
  }

  // The steps that a store keeps: the latest, as far as they fit.
  kept(letters: number): KeptStep[] {
    let left = letters, first = this.before.length;
    while (first > 0 && left - this.before[first - 1]!.text.length > 0) left -= this.before[--first]!.text.length;
    return this.before.slice(first).map(({ text, file }) => (file === this.file ? text : { text, name: file.name }));
  }

  restore(before: KeptStep[]): void {
    const others = new Map<string | null, TextFile>();
    const fileOf = (name: string | null): TextFile => {
      const file = others.get(name) ?? { name, saved: null };
      others.set(name, file);
      return file;
    };
    this.before = before.map((one) => (typeof one === "string" ? { text: one, file: this.file } : { text: one.text, file: fileOf(one.name) }));
  }
}
