// Texts of the server as print has them.
export const RAISED: Record<string, string> = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

// What a terminal spells with the signs of a keyboard, with those of print; a number and its unit stay in one line.
export const typeset = (text: string): string =>
  text.replace(/ -> /g, " → ").replace(/(?<![\d.,])0(?:[.,]0+)?e[+-]?\d+\b/g, "0").replace(/(\d)e([+-]?)0*(\d+)\b/g, (_whole, digit: string, sign: string, power: string) => `${digit}·10${[...(sign === "-" ? "-" : "") + power].map((one) => RAISED[one]).join("")}`)
    .replace(/(?<![\p{L}\d_)\]])-(?=\d)/gu, "−").replace(/(?<=\d) - (?=\d)/g, " − ")
    .replace(/(?<=[\d)]|·10[⁻⁰¹²³⁴-⁹]+) (?=(?:1\/\(?)?(?:\p{L}{1,3}|[%°])(?:[·/²³⁴⁻]|$|[\s,;.:)]))/gu, "\u00a0")
    // a browser breaks a line behind the stroke of "Н·м/рад"
    .replace(/(?<=\u00a0[\p{L}·²³⁴]*\/\(?)(?=\p{Script=Cyrillic})/gu, "\u2060");
