"""The places of a C++ file that a fault can change, found in the syntax tree by libclang (Debian's python3-clang).

A place is a dictionary: "function" (its qualified name), "old" and "new" (texts), "edits" [(begin, end, new text)] in bytes, and
"statement" where the edit drops a statement, "condition" where the texts may be a pointer or an `optional`. Rules, each for what no
test could or should see:
- only what is computed at run time: no types, template arguments, static_assert, case labels, constexpr variables, `if constexpr`
- < and <= are exchanged for integers alone: for numbers the edge has no width. Every other comparison is turned round
- no arithmetic on texts: words of messages are no results; no reserve(), no assertion
- no exchange of the arguments of a symmetric function, or of an object's members
- what a template's operator is is known at its use alone: there the sign between the operands tells an operator from a call
"""

import pathlib
import re

from clang import cindex
from clang.cindex import CursorKind as Kind, TypeKind

OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", "<": ">", ">": "<", "<=": ">", ">=": "<", "==": "!=", "!=": "==",
             "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}
EDGES = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}
DROPS = {"+": "lr", "-": "l", "*": "lr", "/": "l", "&&": "lr", "||": "lr"}
SYMMETRIC = {"min", "max", "fmin", "fmax", "hypot", "swap", "hypot2", "dot", "midpoint"}  # midpoint: of floating-point numbers
SYMMETRIC_IN_TWO = {"fused"}  # a·b + c
FUNCTIONS = {Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.FUNCTION_TEMPLATE, Kind.CONVERSION_FUNCTION}
SCOPES = {Kind.NAMESPACE, Kind.CLASS_DECL, Kind.STRUCT_DECL, Kind.CLASS_TEMPLATE, Kind.CLASS_TEMPLATE_PARTIAL_SPECIALIZATION,
          Kind.LINKAGE_SPEC, Kind.UNEXPOSED_DECL}
LITERALS = {Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL, Kind.CXX_BOOL_LITERAL_EXPR}
HOLDS_LITERAL = {Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR, Kind.CALL_EXPR, Kind.RETURN_STMT, Kind.CONDITIONAL_OPERATOR,
                 Kind.ARRAY_SUBSCRIPT_EXPR, Kind.INIT_LIST_EXPR, Kind.VAR_DECL, Kind.FIELD_DECL, Kind.UNARY_OPERATOR}
INTEGERS = {TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG, TypeKind.SHORT,
            TypeKind.USHORT, TypeKind.UCHAR, TypeKind.SCHAR}


class Finder:
    def __init__(self, path):
        self.path, self.bytes, self.found = str(path), pathlib.Path(path).read_bytes(), []

    def text(self, begin, end):
        return self.bytes[begin:end].decode()

    def of(self, cursor):
        return self.text(cursor.extent.start.offset, cursor.extent.end.offset)

    def add(self, edits, old=None, new=None, **more):
        if all(balanced(self.text(begin, end)) for begin, end, _ in edits):
            self.found.append({"function": self.function, "edits": edits, "old": old or self.text(*edits[0][:2]),
                               "new": new or edits[0][2], **more})

    def change(self, cursor, new, **more):
        self.add([(cursor.extent.start.offset, cursor.extent.end.offset, new)], **more)

    def declarations(self, cursor):
        for child in cursor.get_children():
            if str(child.location.file) != self.path:
                continue
            if child.kind in SCOPES:
                self.declarations(child)
            elif child.kind in FUNCTIONS or child.kind == Kind.FIELD_DECL:
                self.function = qualified(child)
                for part in child.get_children():
                    if part.kind == Kind.COMPOUND_STMT or (child.kind == Kind.FIELD_DECL and part.kind.is_expression()):
                        self.visit(part, child)

    def visit(self, cursor, parent):
        kind = cursor.kind
        constant = kind in (Kind.VAR_DECL, Kind.DECL_STMT) and re.match(r"(static )?constexpr\b", self.of(cursor))
        if kind == Kind.STATIC_ASSERT or constant:  # a statement: of two constants in one the second does not begin with constexpr
            return
        children = list(cursor.get_children())
        if kind == Kind.CASE_STMT or (kind == Kind.IF_STMT and re.match(r"if\s+constexpr", self.of(cursor))):
            children = children[1:]
        elif kind == Kind.IF_STMT and children and children[0].kind.is_expression():
            self.change(children[0], f"!({self.of(children[0])})", condition=True)
        elif kind == Kind.COMPOUND_STMT:
            self.statements(children)
        elif kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR, Kind.CALL_EXPR) and len(children) >= 2:
            self.operator(cursor, children)
        elif kind == Kind.UNARY_OPERATOR and re.match(r"-|!(?!=)", self.of(cursor)):  # a rewritten != looks like a !
            more = {"condition": True} if self.of(cursor)[0] == "!" else {}
            self.change(cursor, self.of(children[0]), **more)
        elif kind == Kind.CONDITIONAL_OPERATOR and len(children) == 3:
            self.exchange(children[1], children[2])
        elif kind in LITERALS and parent.kind in HOLDS_LITERAL and cursor.extent.start.offset > parent.location.offset - (
                0 if parent.kind in (Kind.VAR_DECL, Kind.FIELD_DECL) else 1 << 30):
            self.literal(cursor, parent)
        if kind == Kind.INIT_LIST_EXPR:
            self.arguments(children)
        for child in children:  # implicit conversions stand for what they convert
            self.visit(child, parent if kind == Kind.UNEXPOSED_EXPR else cursor)

    def operator(self, cursor, children):
        left, right = children[0], children[-1]
        begin, end = left.extent.end.offset, right.extent.start.offset
        sign = re.sub(r"//.*|\s", "", self.text(begin, end)) if begin < end else ""
        if cursor.kind == Kind.CALL_EXPR and sign not in OPERATORS:
            name = cursor.spelling or self.of(left).split("::")[-1]
            if not name.startswith("operator") and name not in SYMMETRIC:
                self.arguments(list(cursor.get_arguments())[1 if name in SYMMETRIC_IN_TWO else 0:])
            return
        if sign not in OPERATORS or is_text(left) or is_text(right):
            return
        if "Eigen::" in cursor.type.get_canonical().spelling:  # a switch between two expressions refers to a temporary
            return
        l, r = self.of(left), self.of(right)
        more = {"condition": True} if sign in ("&&", "||") else {}
        change = lambda new: self.add([(left.extent.start.offset, right.extent.end.offset, new)], **more)
        change(f"{l} {OPERATORS[sign]} {r}")
        if sign in EDGES and all(side.type.get_canonical().kind in INTEGERS for side in (left, right)):
            change(f"{l} {EDGES[sign]} {r}")
        for side in DROPS.get(sign, ""):
            change(l if side == "l" else r)

    def arguments(self, given):
        for one, other in zip(given, given[1:]):
            same_type = one.type.get_canonical().spelling == other.type.get_canonical().spelling
            if same_type and self.of(one) != self.of(other) and not self.of(one).startswith('{"'):
                self.exchange(one, other)

    def exchange(self, one, other):
        (a, b), (c, d) = [(side.extent.start.offset, side.extent.end.offset) for side in (one, other)]
        if b <= c and not is_text(one):
            self.add([(a, b, self.text(c, d)), (c, d, self.text(a, b))], self.text(a, d), self.text(c, d) + self.text(b, c) + self.text(a, b))

    def literal(self, cursor, parent):
        text = self.of(cursor)
        if cursor.kind == Kind.CXX_BOOL_LITERAL_EXPR:
            self.change(cursor, {"true": "false", "false": "true"}.get(text, text))
        elif cursor.kind == Kind.INTEGER_LITERAL and re.fullmatch(r"\d+", text):
            self.change(cursor, str(int(text) + 1))
        elif cursor.kind == Kind.FLOATING_LITERAL and re.fullmatch(r"[\d.]+(e[-+]?\d+)?", text):
            self.change(cursor, f"{2 * float(text)!r}" if float(text) else "1.0")

    def statements(self, children):
        for child in children:
            begin, end = child.extent.start.offset, child.extent.end.offset
            after = re.match(rb"\s*;", self.bytes[end:])
            if child.kind.is_expression() and after and not re.search(r"\breserve\(|\bassert\(|\bvoid\b", self.of(child)):
                self.add([(begin, end + after.end(), "")], new="nothing", statement=True)


def is_text(cursor):
    kind = cursor.type.get_canonical()
    return "basic_string" in kind.spelling or "char [" in kind.spelling or "char *" in kind.spelling


def balanced(text):
    return all(text.count(a) == text.count(b) for a, b in ("()", "[]", "{}")) and "#" not in text


def qualified(cursor):
    names = []
    while cursor and cursor.kind != Kind.TRANSLATION_UNIT:
        names.insert(0, cursor.spelling)
        cursor = cursor.semantic_parent
    return "::".join(name for name in names if name)


def cpp_places(root, path, include):
    options = ["-x", "c++", "-std=c++20", "-w", f"-I{root}", *[f"-isystem{folder}" for folder in include]]
    finder = Finder(path)
    finder.declarations(cindex.Index.create().parse(str(path), options).cursor)
    return finder.found
