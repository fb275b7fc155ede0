// Undo and redo are texts: what was, is there again byte by byte.
export class History {
  private before: string[] = [];
  private after: string[] = [];

  constructor(public text: string) {}

  get undoes(): boolean {
    return this.before.length > 0;
  }
  get redoes(): boolean {
    return this.after.length > 0;
  }

  // A new text; `merge` replaces the last one, as letters that are typed behind one another are one step.
  put(text: string, merge = false): void {
    if (text === this.text) return;
    if (!(merge && this.before.length)) this.before.push(this.text);
    this.after = [];
    this.text = text;
  }

  undo(): string | null {
    const text = this.before.pop();
    if (text === undefined) return null;
    this.after.push(this.text);
    return (this.text = text);
  }

  redo(): string | null {
    const text = this.after.pop();
    if (text === undefined) return null;
    this.before.push(this.text);
    return (this.text = text);
  }

  // The steps that a store keeps: the latest, as far as they fit.
  kept(letters: number): string[] {
    let left = letters, first = this.before.length;
    while (first > 0 && left - this.before[first - 1]!.length > 0) left -= this.before[--first]!.length;
    return this.before.slice(first);
  }

  restore(before: string[]): void {
    this.before = before.slice();
  }
}
