// Numbers as text: digits by their spread, a true minus sign, units in their usual form, a dash for a missing value.
(function () {
  "use strict";
  const W = window.wingspread;
  const F = (W.format = {});
  F.DEGREES = 180 / Math.PI;
  F.none = "–";

  const superscripts = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
  F.superscript = (exponent) => [...String(exponent)].map((digit) => superscripts[digit]).join("");
  function power(text) {
    const [mantissa, exponent] = text.split("e");
    return `${mantissa.replace("-", "−")} × 10${F.superscript(Number(exponent))}`;
  }
  function grouped(text) {
    const [whole, fraction] = text.split(".");
    const spaced =
      whole.length > 5 || (whole.length === 5 && whole[0] !== "-")
        ? whole.replace(/\B(?=(\d{3})+(?!\d))/g, ",")
        : whole;
    return (fraction === undefined ? spaced : `${spaced}.${fraction}`).replace("-", "−");
  }

  F.fixed = function (value, decimals) {
    if (!W.isNumber(value)) return F.none;
    const text = value.toFixed(Math.max(0, Math.min(12, decimals)));
    return grouped(Number(text) === 0 ? text.replace("-", "") : text);
  };
  // With a number of significant digits; powers of ten below 1e-4 and from 1e8.
  F.number = function (value, digits = 4) {
    if (!W.isNumber(value)) return F.none;
    if (value === 0) return "0";
    const size = Math.floor(Math.log10(Math.abs(value)));
    if (size < -4 || size > 7) return power(value.toExponential(digits - 1).replace(/\.?0+e/, "e"));
    return F.fixed(value, digits - 1 - size);
  };
  // At most so many significant digits, without trailing zeros; an input as its author wrote it has seven at most.
  F.given = (value) => inDigits(value, 7);
  function inDigits(value, digits) {
    if (!W.isNumber(value)) return F.none;
    const short = Number(value.toPrecision(digits));
    return Math.abs(short) >= 1e7 || (short !== 0 && Math.abs(short) < 1e-4)
      ? power(short.toExponential())
      : grouped(String(short));
  }
  // Decimals that show two significant digits of the spread.
  F.decimals = function (spread, value) {
    if (W.isNumber(spread) && spread > 0) return Math.max(0, 1 - Math.floor(Math.log10(spread)));
    return W.isNumber(value) && value !== 0 ? Math.max(0, 3 - Math.floor(Math.log10(Math.abs(value)))) : 0;
  };
  F.count = (value) => (W.isNumber(value) ? value.toFixed(0).replace(/\B(?=(\d{3})+(?!\d))/g, ",") : F.none);
  F.counted = (value, one, many = one + "s") => `${F.count(value)} ${value === 1 ? one : many}`;
  F.runs = (value) => F.counted(value, "run");

  // Decimals of a share in per cent, so that its distance to 0 or 1 has two significant digits.
  const shareDecimals = (value) =>
    value <= 0 || value >= 1 ? 0 : Math.max(1, 1 - Math.floor(Math.log10(Math.min(value, 1 - value) * 100)));
  F.share = function (value, decimals) {
    if (!W.isNumber(value)) return F.none;
    if (value === 0 || value === 1) return `${100 * value} %`;
    if (Math.min(value, 1 - value) < 1e-6)
      return value < 0.5 ? `${F.number(100 * value, 2)} %` : `${F.fixed(100 * value, Math.max(shareDecimals(value), decimals || 0))} %`;
    return `${F.fixed(100 * value, decimals === undefined ? shareDecimals(value) : decimals)} %`;
  };
  F.shareBounds = function (lower, upper) {
    if (!W.isNumber(lower) && !W.isNumber(upper)) return "no bounds";
    if (lower === 0) return `below ${F.share(upper)}`;
    if (upper === 1) return `above ${F.share(lower)}`;
    const decimals = Math.min(12, Math.max(shareDecimals(lower), shareDecimals(upper)));
    return `${F.share(lower, decimals)} – ${F.share(upper, decimals)}`;
  };

  // The level of a quantile: "1 %", "99.5 %".
  F.level = (p) => `${inDigits(100 * p, 12)} %`;
  F.quantileName = (p) => (p === 0.5 ? "Median" : `${F.level(p)} quantile`);

  // Units: "N m" reads N·m; radians may be shown in degrees.
  F.unit = (unit) => (unit || "").replace(/ /g, "·").replace(/\^2/g, "²").replace(/\*/g, "·");
  F.angular = (unit) => unit === "rad" || unit === "rad/s" || unit === "rad/s^2";
  F.shown = function (unit) {
    const degrees = W.chosen.angles === "deg" && F.angular(unit);
    return { factor: degrees ? F.DEGREES : 1, unit: degrees ? unit.replace("rad", "deg") : F.unit(unit) };
  };
  // A limit as its author wrote it: in degrees where that is the shorter number, "5 deg/s". The displayed unit follows in
  // brackets if it is another.
  // A number with more than ten digits comes from a conversion to SI and is shown with six: 56.4924 N·m of "500 in*lbf".
  const givenDigits = (value) => inDigits(value, String(value).replace(/\D/g, "").length > 10 ? 6 : 10);
  F.written = function (value, unit) {
    if (!F.angular(unit)) return `${givenDigits(value)} ${F.unit(unit)}`.trim();
    const degrees = Number((value * F.DEGREES).toPrecision(12)),
      short = String(degrees).length < String(value).length,
      inDegrees = `${givenDigits(degrees)} ${F.unit(unit).replace("rad", "deg")}`,
      inRadians = `${givenDigits(value)} ${F.unit(unit)}`;
    if (short) return W.chosen.angles === "deg" ? inDegrees : `${inDegrees} (${F.number(value, 4)} ${F.unit(unit)})`;
    return W.chosen.angles === "rad" ? inRadians : `${inRadians} (${F.number(degrees, 4)} ${F.unit(unit).replace("rad", "deg")})`;
  };
  // A value of an output in the displayed unit, as precise as two digits of its spread. Value and spread are in SI units.
  F.value = function (value, unit, spread) {
    const { factor } = F.shown(unit);
    if (!W.isNumber(value)) return F.none;
    if (W.isNumber(spread) && spread > 0) return F.sized(value * factor, spread * factor);
    return !unit && Number.isInteger(value) ? F.given(value) : F.number(value * factor, 5); // a count that never varies
  };
  // A spread below 1e-12 of the value is rounding noise.
  F.sized = function (value, spread) {
    const size = Math.abs(value),
      decimals = F.decimals(spread, value);
    if (decimals <= 7 && size < 1e8) return F.fixed(value, decimals);
    if (!(spread > 1e-12 * size)) return F.number(value, 4);
    return size >= 1e8 || size < 1e-4 ? F.number(value, Math.max(4, Math.floor(Math.log10(size)) + 1 + decimals)) : F.fixed(value, decimals);
  };
  F.withUnit = (value, unit, spread) =>
    W.isNumber(value) ? `${F.value(value, unit, spread)} ${F.shown(unit).unit}`.trim() : F.none;

  // Precision of a column: a tenth of its standard deviation, so that values show three digits of their spread.
  F.grain = (output) => (W.isNumber(output.std) && output.std > 0 ? output.std / 10 : null);
  // A limit among the values of an output, in the displayed unit: as precise as they are, with six digits at least.
  F.limit = function (value, output) {
    const shown = value * F.shown(output.unit).factor,
      needed = shown ? Math.floor(Math.log10(Math.abs(shown))) + 1 + F.decimals(F.grain(output) * F.shown(output.unit).factor) : 0;
    return inDigits(shown, Math.max(6, Math.min(15, needed)));
  };
  F.name = (output) =>
    output.hinge && output.name.startsWith(output.hinge + ".")
      ? `${output.hinge} ${words(output.name.slice(output.hinge.length + 1))}`
      : words(output.name);
  // The axis title of a quantity: "root peak moment (N·m)".
  F.axis = (text, unit) => (unit ? `${text} (${unit})` : text);
  const known = (name) => W.sets.flatMap(W.outputsOf).find((one) => one.name === name);
  F.nameOf = (name) => (known(name) ? F.name(known(name)) : words(name));
  F.unitOf = (name) => (known(name) || {}).unit || "";
  function words(text) {
    return text.replace(/\bovertravel$/, "overtravel (beyond stowed)").replace(/_/g, " ").replace(/\./g, " ");
  }
  // A wing of one hinge has one order: its name, which may be "others".
  const isHinge = (name) =>
    W.sets.some((set) => [((set.wing || {}).hinges || []).map((one) => one.name), ...(set.wing_orders || []).map((wing) => wing.hinges)].some((names) => names.length === 1 && names[0] === name));
  F.isOthers = (order) => order === "others" && !isHinge(order);
  F.order = (order) => (order === "no latch" ? "no hinge latched" : F.isOthers(order) ? "other orders" : order.replace(/>/g, " › "));

  // A number beside its axis, with the digits that tell ticks a step apart.
  F.tick = function (value, step) {
    if (value === 0) return "0";
    const size = Math.floor(Math.log10(Math.abs(value))),
      digits = Math.min(15, step > 0 ? size - Math.floor(Math.log10(step) + 1e-9) + 1 : 0);
    return Math.abs(value) >= 1e6 || Math.abs(value) < 1e-4
      ? power(value.toExponential(Math.max(1, digits - 1)).replace(/\.?0+e/, "e"))
      : grouped(String(Number(value.toPrecision(Math.max(6, digits)))));
  };
  F.ticks = function (values) {
    const step = d3.min(d3.pairs(values), ([a, b]) => Math.abs(b - a));
    return (value) => F.tick(value, step);
  };
})();
