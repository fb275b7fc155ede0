// Dimensions as sliders and fields, numbers at the cursor, what the statuses say, and what can be taken away: CSV.
class Sliders {
  constructor(holder, model, settle) {
    this.model = model;
    this.rows = model.parameters.map((one) => this.row(one, holder.querySelector(".rows"), settle));
    this.reset = holder.querySelector('[data-do="reset"]');
    this.undo = holder.querySelector('[data-do="undo"]');
    this.reset.addEventListener("click", () => {
      model.keep();
      model.restore(model.nominal);
      settle();
    });
    this.undo.addEventListener("click", () => {
      model.undo();
      settle();
    });
    model.watchers.push(() => this.show());
    this.show();
  }

  row(one, parent, settle) {
    const { model } = this, unit = model.unit(one), name = model.data.names[one.path] ?? one.path;
    const range = element("input", { type: "range", min: one.least, max: one.most, step: "any", "aria-label": name });
    const field = element("input", { type: "text", inputMode: "decimal", autocomplete: "off", "aria-label": withUnit(name, unit.label && `, ${unit.label}`) });
    range.addEventListener("pointerdown", () => model.keep());
    range.addEventListener("keydown", (event) => !event.repeat && model.keep());
    range.addEventListener("input", () => {
      // a thumb is a pixel wide: what is near the description's own value is that value
      const value = Number(range.value), near = Math.abs(value - one.value) < 0.004 * (one.most - one.least);
      model.change({ [one.path]: near ? one.value : value });
    });
    range.addEventListener("change", settle);
    field.addEventListener("change", () => {
      const value = model.spelling.read(field.value) / unit.factor;
      const right = Number.isFinite(value) && value >= one.least - 1e-9 * Math.abs(one.least) && value <= one.most + 1e-9 * Math.abs(one.most);
      field.setAttribute("aria-invalid", String(!right));
      this.note.textContent = right ? "" : fill(model.words.outside, {
        name, least: model.spelling.number(one.least * unit.factor), most: withUnit(model.spelling.number(one.most * unit.factor), unit.label),
      });
      if (!right) return;
      model.keep();
      model.change({ [one.path]: value });
      settle();
    });
    this.note = this.note ?? parent.parentNode.querySelector(".note");
    const label = element("span", { className: "name", title: one.path }, name);
    const row = element("div", { className: "row" }, label, range, field, element("span", { className: "unit" }, unit.label));
    parent.append(row);
    return { one, unit, range, field, row };
  }

  show() {
    const { model } = this;
    this.rows.forEach(({ one, unit, range, field, row }, k) => {
      const value = model.values[k];
      if (document.activeElement !== range || Math.abs(Number(range.value) - value) > 1e-12) range.value = String(value);
      range.setAttribute("aria-valuetext", withUnit(model.spelling.number(value * unit.factor), unit.label));
      if (document.activeElement !== field || field.getAttribute("aria-invalid") !== "true") {
        field.value = model.spelling.number(value * unit.factor, 6);
        field.setAttribute("aria-invalid", "false");
      }
      row.classList.toggle("changed", value !== one.value);
    });
    this.reset.disabled = !model.changed;
    this.undo.disabled = !model.undone.length;
  }
}

// What can be said of the whole motion: where it is not reached, its limits, residuals above their bound, change points.
class Statuses {
  constructor(holder, band, model, copy) {
    this.holder = holder;
    this.band = band;
    this.model = model;
    this.copy = copy;
    model.watchers.push(() => this.show());
    this.show();
  }

  show() {
    const { model } = this, { words, frame } = model, said = [], notes = [...model.data.drawing.notDrawn];
    if (!frame.possible) said.push({ kind: "bad", text: words.impossible });
    else {
      for (const { from, to, status, fits } of piecesOf(model)) {
        if (model.data.reached[status]) continue;
        said.push({ kind: "bad", sign: bandOf({ status, fits }), text: fill(from === to ? words.at_one : words.between, {
          status: fits ? words.statuses[status] : this.misfit(status, from, to), from: model.place(from), to: model.place(to),
        }) });
      }
      const limits = frame.events.filter((event) => markOf(event) === "limit");
      const places = [...new Set(limits.map((event) => model.placeOf(event.drive)))];
      if (places.length) said.push({ kind: "", sign: "mark limit", text: fill(words.limits_at, { places: places.join("; ") }) });
    }
    for (const cam of model.data.drawing.cams) {
      const { fits, arm, length } = camNow(model, cam), { factor, label } = model.data.units.m;
      const told = (value) => withUnit(model.spelling.number(value * factor), label);
      if (!fits) notes.push(fill(words.cam_arm, { arm: told(arm), length: told(length) }));
    }
    const misfit = !piecesOf(model).every((piece) => piece.fits), command = frame.signsChange || misfit ? commandOf(model) : "";
    const key = JSON.stringify([said, notes, command]);
    if (key !== this.key) {
      this.key = key;
      const items = said.slice(0, 12).map((one) => element("p", { className: one.kind }, ...this.sign(one.sign), one.text));
      if (!said.length && !frame.signsChange) items.push(element("p", { className: "good" }, words.all_reached));
      if (misfit) items.push(this.advice("misfit", words.misfit, command));
      if (frame.signsChange) items.push(this.changePoints(command));
      items.push(...notes.map((told) => element("p", { className: "omitted" }, told)));
      this.holder.replaceChildren(...items);
    }
    this.strip();
  }

  changePoints(command) {
    const { words } = this.model;
    const places = [...new Set(this.model.frame.events.filter((event) => markOf(event) !== "limit").map((event) => this.model.placeOf(event.drive)))];
    return this.advice("change", fill(words.change_points, { places: places.join("; ") }), command);
  }

  // What helps, with a command to copy.
  advice(kind, told, command) {
    const button = element("button", { type: "button" }, this.model.words.copy_command);
    button.addEventListener("click", () => this.copy(command, this.model.words.command_copied));
    return element("div", { className: `advice ${kind}` }, element("p", {}, ...this.sign(kind === "change" && "mark change"), told),
      element("div", { className: "command" }, element("code", {}, command), button));
  }

  // What stands for it along the slider and in the curves.
  sign(name) {
    if (!name) return [];
    const svg = make("svg", { class: "sign", viewBox: "0 0 14 14", "aria-hidden": "true" });
    if (name.startsWith("band")) make("rect", { class: name, width: 14, height: 14 }, svg);
    else make("line", { class: name, x1: 7, x2: 7, y1: 0, y2: 14 }, svg);
    return [svg];
  }

  misfit(status, from, to) {
    const { words, frame, spelling } = this.model, worst = greatestOf(frame.misfit.subarray(from, to + 1));
    return fill(words.misfit_status, {
      status: words.statuses[status], worst: spelling.number(worst, 2), bound: spelling.number(frame.residualBound, 2),
    });
  }

  // The same along the slider of the player.
  strip() {
    const { model, band } = this, last = model.last || 1;
    band.replaceChildren();
    const svg = make("svg", { viewBox: `0 0 1000 10`, preserveAspectRatio: "none", "aria-hidden": "true" });
    for (const piece of piecesOf(model)) {
      const { from, to, status } = piece;
      if (model.data.reached[status]) continue;
      const start = (1000 * Math.max(0, from - 0.5)) / last, end = (1000 * Math.min(last, to + 0.5)) / last;
      make("rect", { class: bandOf(piece), x: start, y: 0, width: end - start, height: 10 }, svg);
    }
    for (const event of model.frame.events) {
      const sample = sampleOf(model, event.drive);
      if (sample !== null) make("rect", { class: `mark ${markOf(event)}`, x: within((1000 * sample) / last - 2, 0, 996), y: 0, width: 4, height: 10 }, svg);
    }
    band.append(svg);
  }
}

// The command that computes the mechanism as it is now.
const commandOf = (model) => {
  const quoted = (told) => (/^[\w./-]+$/.test(told) ? told : `"${told.replaceAll(/(["$`\\])/g, "\\$1")}"`);
  const changed = model.parameters.filter((one, k) => model.values[k] !== one.value)
    .map((one) => `--set "${one.path}=${model.value(one.path)}${one.unit === "1" ? "" : ` ${one.unit}`}"`);
  return ["centrode run", quoted(model.data.source), ...changed].join(" ");
};

// Every number of the motion at the cursor, by kind.
class Numbers {
  constructor(holder, stage, model) {
    this.holder = holder;
    this.body = holder.querySelector(".numbers");
    this.stage = stage;
    this.model = model;
    holder.addEventListener("toggle", () => this.show());
  }

  show() {
    if (!this.holder.open) return;
    const { model } = this, sample = within(Math.round(this.stage.place), 0, model.last);
    if (!this.rows) this.lay();
    for (const { cells, course } of this.rows) {
      model.lines(course).forEach((line, k) => {
        const said = model.spelling.number(line.value(sample), 6);
        if (cells[k].textContent !== said) cells[k].textContent = said;
      });
    }
    this.caption.textContent = `${model.place(sample)} · ${model.words.statuses[model.status(sample)]}`;
  }

  lay() {
    const { model } = this;
    this.caption = element("p", { className: "caption" });
    const body = element("tbody");
    this.rows = model.data.courses.map((course) => {
      const lines = model.lines(course);
      const cells = lines.map((line, k) => {
        const cell = element("td", { className: "n" });
        const first = k ? [] : [element("th", { scope: "rowgroup", rowSpan: lines.length }, course.label)];
        body.append(element("tr", {}, ...first, element("td", {}, ...indexed(line.label)), cell, element("td", {}, course.unit)));
        return cell;
      });
      return { course, cells };
    });
    this.body.replaceChildren(this.caption, element("div", { className: "table", tabIndex: 0, role: "region", "aria-label": model.words.numbers }, element("table", {}, body)));
  }
}

// The whole motion as CSV, spelled as spreadsheets of the reader's language read it.
const tableOf = (model) => {
  const { parameter, words, courses, decimal } = model.data, separator = decimal === "," ? ";" : ",";
  const quoted = (cell) => (/[",;\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell);
  const head = (name, unit) => (unit ? `${name} [${unit}]` : name);
  const heads = [head(parameter.symbol, parameter.label), words.status], columns = [];
  for (const course of courses) {
    for (const line of model.lines(course)) {
      heads.push(head(line.label, course.unit));
      columns.push(line.value);
    }
  }
  const spelled = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(15))).replace(".", decimal) : "");
  const lines = [heads.map(quoted).join(separator)];
  for (let k = 0; k <= model.last; k += 1) {
    const cells = [spelled(model.abscissa[k] * parameter.factor), words.statuses[model.status(k)], ...columns.map((column) => spelled(column(k)))];
    lines.push(cells.map(quoted).join(separator));
  }
  return `${lines.join("\n")}\n`;
};
