// What a link keeps behind `#s=`: the digest of the structure, changed dimensions, place and view, and a sum over them,
// so that a link that lost letters is known from one of another mechanism.
const sumOf = (told) => {
  let sum = 0x811c9dc5;
  for (let k = 0; k < told.length; k += 1) sum = Math.imul(sum ^ told.charCodeAt(k), 0x01000193) >>> 0;
  return sum.toString(36);
};
const encode = (told) => btoa(String.fromCharCode(...new TextEncoder().encode(told))).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
const decode = (text) => new TextDecoder("utf-8", { fatal: true }).decode(
  Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0)));

// Three rows of three numbers, square to each other and as long as 1: how the sphere is turned.
const isRotation = (rows) => Array.isArray(rows) && rows.length === 3
  && rows.every((row) => Array.isArray(row) && row.length === 3 && row.every(Number.isFinite))
  && rows.every((row, k) => rows.every((other, j) => Math.abs(dot(row, other) - (j === k ? 1 : 0)) < 1e-6));

class StateLink {
  constructor(model, stage, curves, boxes) {
    Object.assign(this, { model, stage, curves, boxes });
  }

  get digest() {
    return this.model.data.program.digest;
  }

  get text() {
    const { model, stage } = this, changed = {};
    model.parameters.forEach((one, k) => {
      if (model.values[k] !== one.value) changed[one.path] = model.values[k];
    });
    const state = {
      v: changed, p: Number(stage.place.toFixed(3)), c: this.curves.keys,
      s: [...this.boxes].filter((box) => box.checked).map((box) => box.dataset.show ?? box.dataset.do),
      r: Math.log2(stage.speed), w: stage.data.view ? stage.space.view : undefined,
      k: stage.body ? stage.body.value : undefined,
    };
    const told = encode(JSON.stringify(state));
    return `${this.digest}.${told}.${sumOf(this.digest + told)}`;
  }

  // What is wrong with a link, in words; nothing where it has been taken over.
  take(text) {
    const { words } = this.model, parts = text.split(".");
    if (parts.length !== 3 || sumOf(parts[0] + parts[1]) !== parts[2]) return words.damaged;
    if (parts[0] !== this.digest) return words.foreign;
    let state;
    try {
      state = JSON.parse(decode(parts[1]));
    } catch {
      return words.damaged;
    }
    return this.right(state) ? this.put(state) : words.damaged;
  }

  right(state) {
    const { model, stage } = this, number = Number.isFinite;
    const values = state && state.v && typeof state.v === "object" && !Array.isArray(state.v) ? Object.entries(state.v) : null;
    return values !== null && number(state.p) && number(state.r) && Array.isArray(state.c) && Array.isArray(state.s)
      && values.every(([path, value]) => {
        const one = model.parameters[model.places.get(path)];
        return one && number(value) && value >= one.least && value <= one.most;
      })
      && (state.w === undefined || isRotation(state.w))
      && (state.k === undefined || !stage.body || [...stage.body.options].some((one) => one.value === state.k));
  }

  put(state) {
    const { model, stage } = this;
    model.keep();
    model.values = model.nominal.slice();
    for (const [path, value] of Object.entries(state.v)) model.values[model.places.get(path)] = value;
    model.renew();
    model.show();
    if (stage.data.view && state.w) stage.space.view = state.w;
    for (const box of this.boxes) {
      const on = state.s.includes(box.dataset.show ?? box.dataset.do);
      if (box.checked !== on) box.click();
    }
    const speed = stage.holder.querySelector('[data-do="speed"]');
    speed.value = String(within(state.r, Number(speed.min), Number(speed.max)));
    speed.dispatchEvent(new Event("input"));
    if (stage.body && state.k) {
      stage.body.value = state.k;
      stage.renewCentrodes();
    }
    this.curves.choose(state.c.filter((key) => typeof key === "string"));
    stage.fit();
    stage.go(state.p);
    return "";
  }
}
