// Numbers with units, as people read them.

const PREFIXES = { "-18": "a", "-15": "f", "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G" };

// What to divide by, and the unit with its prefix.
export function scaled(largest, unit) {
  if (!Number.isFinite(largest) || largest === 0) return [1, unit];
  const power = Math.min(Math.max(3 * Math.floor(Math.log10(Math.abs(largest) * 1.00005) / 3), -18), 9);
  return [10 ** power, PREFIXES[power] + unit];
}

export function amount(value, unit = "") {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (!unit) return short(value, 5);
  const [factor, prefixed] = scaled(value, unit);
  return `${short(value / factor, 4)} ${prefixed}`;
}

export function short(value, digits = 4) {
  const rounded = Number(value.toPrecision(digits));
  const size = Math.abs(rounded);
  return size !== 0 && (size < 1e-3 || size >= 1e6) ? rounded.toExponential() : String(rounded);
}

// Shares of a sum in per cent that add up to 100 as they are written: what rounding down leaves goes
// to the largest remainders. The same rule as asperity/shares.py.
export function shares(parts, places = 1) {
  const sizes = parts.map((part) => (part > 0 ? part : 0));
  const total = sizes.reduce((sum, size) => sum + size, 0);
  const unit = 10 ** places;
  const exact = sizes.map((size) => (total > 0 ? (size / total) * 100 * unit : 0));
  const steps = exact.map(Math.floor);
  const missing = total > 0 ? 100 * unit - steps.reduce((sum, step) => sum + step, 0) : 0;
  const order = [...exact.keys()].sort((a, b) => exact[b] - steps[b] - (exact[a] - steps[a]));
  for (const k of order.slice(0, missing)) steps[k] += 1;
  return steps.map((step, k) => (step || !sizes[k] ? `${step / unit} %` : `< ${1 / unit} %`));
}

export function largest(arrays) {
  let most = 0;
  for (const values of arrays) for (const value of values) if (Math.abs(value) > most) most = Math.abs(value);
  return most;
}

// "10.5 nm" -> [10.5, "nm"]; null where it is no number with a unit.
export function parted(text) {
  const found = /^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$/.exec(String(text));
  return found ? [Number(found[1]), found[2]] : null;
}
