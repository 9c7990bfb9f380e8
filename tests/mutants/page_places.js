// Prints the places of a script of the report's page that a fault can change, as JSON: see places.py. Needs Debian's node-acorn.
"use strict";
const acorn = require("acorn"),
  walk = require("acorn-walk"),
  text = require("fs").readFileSync(process.argv[2], "utf8");
const swaps = { "+": "-", "-": "+", "*": "/", "/": "*", "<": ">=", ">": "<=", "<=": ">", ">=": "<", "===": "!==", "!==": "===" };
const places = [];
// Lengths in pixels are taste: numbers in functions that draw are left alone, and so is what is only written to the console.
const draws = (above) => // the first four are the file, its wrapper and its body
  above.slice(4).some((one) => /Function/.test(one.type) && (one.params.some((each) => /^(svg|box|width)$/.test(each.name)) || of(one).includes("M.small(")));
const isNumber = (node) => node.type === "Literal" && typeof node.value === "number";
const of = (node) => text.slice(node.start, node.end);
// `+` joins texts too; pieces of sentences are no results.
const isText = (node) =>
  node.type === "TemplateLiteral" || typeof node.value === "string" || (node.type === "BinaryExpression" && (isText(node.left) || isText(node.right)));
walk.fullAncestor(acorn.parse(text, { ecmaVersion: "latest" }), function (node, _, above) {
  const named = above.map((one) => one.id?.name ?? (one.type === "AssignmentExpression" && one.right.body ? of(one.left) : "")).filter(Boolean);
  const edit = (edits, old, changed) => places.push({ function: named.join("."), edits, old, new: changed });
  const change = (changed) => edit([[node.start, node.end, changed]], of(node), changed);
  const exchange = (a, b) =>
    (draws(above) && (isNumber(a) || isNumber(b))) ||
    edit([[a.start, a.end, of(b)], [b.start, b.end, of(a)]], text.slice(a.start, b.end), of(b) + text.slice(a.end, b.start) + of(a));
  if (node.type === "BinaryExpression" && swaps[node.operator] && !isText(node) && !(draws(above) && (isNumber(node.left) || isNumber(node.right)))) {
    change(`${of(node.left)} ${swaps[node.operator]} ${of(node.right)}`);
    if ("+-*/".includes(node.operator)) change(of(node.left));
  }
  if (node.type === "LogicalExpression" && node.operator !== "??") [node.left, node.right].forEach((side) => change(of(side)));
  if (node.type === "UnaryExpression" && "-!".includes(node.operator)) change(of(node.argument));
  if (node.type === "ConditionalExpression") exchange(node.consequent, node.alternate);
  if (isNumber(node) && !draws(above)) change(String(node.value + 1));
  if (node.type === "Literal" && typeof node.value === "boolean") change(String(!node.value));
  if (node.type === "CallExpression" && node.callee.property?.name === "min") change(of(node).replace("min", "max"));
  if (node.type === "CallExpression" && node.callee.property?.name === "max") change(of(node).replace("max", "min"));
  const list = node.type === "CallExpression" ? node.arguments : node.type === "ArrayExpression" ? node.elements : [];
  for (let k = 1; k < list.length; ++k) if (list[k] && of(list[k]) !== of(list[k - 1])) exchange(list[k - 1], list[k]);
  if (node.type === "ExpressionStatement" && !/^("use strict"|console)/.test(of(node))) change(";");
});
console.log(JSON.stringify(places));
