// Derives the strings of The Algorithmic Beauty of Plants that tests/unit/lsystem_grammar_test.cpp expects, with an
// implementation that is not ours (figure 1.31: see there), and prints their lengths and FNV-1a hashes:
//   npm install lindenmayer@1.5.4 && node abop_strings.mjs
// Parametric modules are printed as name(parameters), each parameter with 6 significant digits.
import LSystem from "lindenmayer";

function hash(text) {
	let h = 0xcbf29ce484222325n;
	for (const c of Buffer.from(text)) h = ((h ^ BigInt(c)) * 0x100000001b3n) & 0xffffffffffffffffn;
	return "0x" + h.toString(16);
}

function report(name, text) {
	const count = (c) => text.split(c).length - 1;
	console.log(name, "length", text.length, "F", count("F"), "[", count("["), hash(text));
}

const plain = {
	"1.24a": ["F", { F: "F[+F]F[-F]F" }, 5],
	"1.24b": ["F", { F: "F[+F]F[-F][F]" }, 5],
	"1.24c": ["F", { F: "FF-[-F+F+F]+[+F-F-F]" }, 4],
	"1.24d": ["X", { X: "F[+X]F[-X]+X", F: "FF" }, 7],
	"1.24e": ["X", { X: "F[+X][-X]FX", F: "FF" }, 7],
	"1.24f": ["X", { X: "F-[[X]+X]+F[+FX]-X", F: "FF" }, 5],
};
for (const [name, [axiom, productions, steps]] of Object.entries(plain))
	report(name, new LSystem({ axiom, productions }).iterate(steps));

// Figure 1.31: the rules for 000, 001, ... 111, and the number of steps.
const hogeweg = {
	"1.31a": [["0", "1[+F1F1]", "1", "1", "0", "1F1", "0", "0"], 30],
	"1.31b": [["1", "1[-F1F1]", "1", "1", "0", "1F1", "1", "0"], 30],
	"1.31c": [["0", "1", "0", "1[+F1F1]", "0", "1F1", "0", "0"], 26],
	"1.31d": [["1", "0", "0", "1F1", "1", "1[+F1F1]", "1", "0"], 24],
	"1.31e": [["0", "1[-F1F1]", "1", "1", "0", "1F1", "1", "0"], 26],
};
// The package looks past the end of a branch for a context to the right, where there is none (ABOP 1.8), so these
// are derived here, on nested lists: an axis is a list of symbols and of branches, which are axes themselves.
function parse(symbols) {
	const axis = [];
	while (symbols.length > 0) {
		const symbol = symbols.shift();
		if (symbol === "]") break;
		axis.push(symbol === "[" ? parse(symbols) : symbol);
	}
	return axis;
}
const unparse = (axis) => axis.map((part) => (Array.isArray(part) ? `[${unparse(part)}]` : part)).join("");
const signal = (part) => part === "0" || part === "1";
function step(axis, below, successors) {
	let left = below;
	return axis.flatMap((part, i) => {
		if (Array.isArray(part)) return [step(part, left, successors)];
		if (!signal(part)) return [{ "+": "-", "-": "+" }[part] ?? part];
		const right = axis.slice(i + 1).find(signal);
		const context = left + part + right;
		left = part;
		return context.length === 3 ? parse([...successors[parseInt(context, 2)]]) : [part];
	});
}
for (const [name, [successors, steps]] of Object.entries(hogeweg)) {
	let axis = parse([..."F1F1F1"]);
	for (let i = 0; i < steps; i++) axis = step(axis, "", successors);
	report(name, unparse(axis));
}

// Parametric: arrays of symbols with numbers.
const m = (symbol, ...params) => ({ symbol, params });
function print(modules) {
	return modules
		.map(({ symbol, params }) => symbol + (params?.length ? `(${params.map((p) => Number(p.toPrecision(6))).join(",")})` : ""))
		.join("");
}
function parametric(name, axiom, productions, steps) {
	const system = new LSystem({ axiom, productions });
	system.iterate(steps);
	const modules = system.axiom;
	const f = modules.filter((x) => x.symbol === "F");
	const sum = f.reduce((total, x) => total + (x.params?.[0] ?? 0), 0);
	report(name, print(modules));
	console.log("  modules", modules.length, "F", f.length, "length of wood", sum.toPrecision(12));
}
{
	const [r1, r2, a0, a2, d, wr] = [0.9, 0.6, 45, 45, 137.5, 0.707];
	parametric("2.6", [m("A", 1, 10)], {
		A: ({ part: { params: [l, w] } }) => [
			m("!", w), m("F", l), m("["), m("&", a0), m("B", l * r2, w * wr), m("]"), m("/", d), m("A", l * r1, w * wr)],
		B: ({ part: { params: [l, w] } }) => [
			m("!", w), m("F", l), m("["), m("-", a2), m("$"), m("C", l * r2, w * wr), m("]"), m("C", l * r1, w * wr)],
		C: ({ part: { params: [l, w] } }) => [
			m("!", w), m("F", l), m("["), m("+", a2), m("$"), m("B", l * r2, w * wr), m("]"), m("B", l * r1, w * wr)],
	}, 10);
}
{
	const [r1, r2, a1, a2, wr] = [0.9, 0.7, 10, 60, 0.707];
	parametric("2.7", [m("A", 1, 10)], {
		A: ({ part: { params: [l, w] } }) => [
			m("!", w), m("F", l), m("["), m("&", a1), m("B", l * r1, w * wr), m("]"), m("/", 180),
			m("["), m("&", a2), m("B", l * r2, w * wr), m("]")],
		B: ({ part: { params: [l, w] } }) => [
			m("!", w), m("F", l), m("["), m("+", a1), m("$"), m("B", l * r1, w * wr), m("]"),
			m("["), m("-", a2), m("$"), m("B", l * r2, w * wr), m("]")],
	}, 10);
}
{
	const [d1, d2, a, lr, vr] = [94.74, 132.63, 18.95, 1.109, 1.732];
	const arm = () => [m("["), m("&", a), m("F", 50), m("A"), m("]")];
	parametric("2.8", [m("!", 1), m("F", 200), m("/", 45), m("A")], {
		A: () => [m("!", vr), m("F", 50), ...arm(), m("/", d1), ...arm(), m("/", d2), ...arm()],
		F: ({ part: { params: [l] } }) => [m("F", l * lr)],
		"!": ({ part: { params: [w] } }) => [m("!", w * vr)],
	}, 6);
}
