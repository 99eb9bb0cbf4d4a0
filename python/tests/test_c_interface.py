"""The structures and functions of the package are those of the C interface, as a compiler sees it.

A program is compiled that says of each structure how large it is, where its members are and what
they hold, and of each function what it takes and gives. It does not compile where a member has
another name, or where there are more of them or fewer.
"""

import ctypes
import inspect
import os
import shutil
import subprocess

import pytest
from conftest import ROOT

from pentimento import _library

STRUCTURES = [
    kind
    for _, kind in inspect.getmembers(_library, inspect.isclass)
    if issubclass(kind, ctypes.Structure)
]
NUMBERS = {
    ctypes.c_int32: "i32",
    ctypes.c_int64: "i64",
    ctypes.c_uint32: "u32",
    ctypes.c_uint64: "u64",
    ctypes.c_double: "f64",
    ctypes.c_char_p: "*char",
    ctypes.c_void_p: "*",
}

CODES = """
#include "pent_plugin_meshes.h"

#include <cstddef>
#include <cstdio>
#include <string>
#include <type_traits>

template <typename T>
std::string code() {
    using Bare = std::remove_cv_t<T>;
    if constexpr (std::is_pointer_v<Bare>) {
        return "*" + code<std::remove_pointer_t<Bare>>();
    } else if constexpr (std::is_array_v<Bare>) {
        return code<std::remove_extent_t<Bare>>() + "[" + std::to_string(std::extent_v<Bare>) + "]";
    } else if constexpr (std::is_same_v<Bare, char>) {
        return "char";
    } else if constexpr (std::is_arithmetic_v<Bare>) {
        return (std::is_floating_point_v<Bare> ? "f" : std::is_signed_v<Bare> ? "i" : "u")
               + std::to_string(8 * sizeof(Bare));
    }@structures@
    return "?";
}

template <typename Result, typename... Arguments>
std::string codes(Result (*)(Arguments...)) {
    std::string all = code<Result>();
    ((all += " " + code<Arguments>()), ...);
    return all;
}

template <typename Function>
void function(const char* name) {
    std::printf("%s %s\\n", name, codes(static_cast<Function>(nullptr)).c_str());
}

int main() {
@main@
}
"""


def c_name(structure: type) -> str:
    return inspect.getdoc(structure).strip("`.")  # what it is documented to be


def c_member(name: str) -> str:
    return name[: -len("_axis")] if name.endswith("_axis") else name  # `from` is a keyword


def code(kind: type) -> str:
    if kind in NUMBERS:
        return NUMBERS[kind]
    if issubclass(kind, ctypes.Structure):
        return c_name(kind)
    if hasattr(kind, "_length_"):
        return f"{code(kind._type_)}[{kind._length_}]"
    return "*" + code(kind._type_)


def fits(found: str, expected: str) -> bool:
    """Whether a C type is handed over well as this one: c_void_p stands for all but text."""
    if expected.endswith("*"):
        return found.startswith(expected) and found != expected + "char"
    return found == expected


def program() -> str:
    names = [c_name(structure) for structure in STRUCTURES]
    known = "".join(
        f' else if constexpr (std::is_same_v<Bare, {name}>) {{\n        return "{name}";\n    }}'
        for name in names
    )
    lines = []
    for structure, name in zip(STRUCTURES, names):
        members = [c_member(field[0]) for field in structure._fields_]
        lines.append(f'{{ {name} all{{}}; auto& [{", ".join("m_" + m for m in members)}] = all;')
        lines += [f"(void)m_{member};" for member in members]
        lines.append(f'std::printf("{name} %zu\\n", sizeof({name}));')
        lines += [
            f'std::printf("{name}.{member} %zu %s\\n", offsetof({name}, {member}),'
            f" code<decltype({name}::{member})>().c_str());"
            for member in members
        ]
        lines.append("}")
    lines += [f'function<decltype(&{name})>("{name}");' for name in _library._FUNCTIONS]
    return CODES.replace("@structures@", known).replace("@main@", "\n".join(lines))


@pytest.fixture(scope="module")
def compiled(tmp_path_factory) -> dict[str, list[str]]:
    """What the compiler says of each structure, member and function."""
    compiler = os.environ.get("CXX") or shutil.which("c++")
    if compiler is None:
        pytest.skip("there is no C++ compiler: let CXX name one")
    folder = tmp_path_factory.mktemp("c_interface")
    (folder / "main.cpp").write_text(program())
    include = ROOT / "plugin" / "include"
    words = [compiler, "-std=c++17", f"-I{include}", "main.cpp", "-o", "main"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    said = subprocess.run([folder / "main"], check=True, capture_output=True, text=True).stdout
    return {line.split()[0]: line.split()[1:] for line in said.splitlines()}


@pytest.mark.parametrize("structure", STRUCTURES, ids=c_name)
def test_structures_lie_in_memory_as_the_compiler_lays_them(structure, compiled):
    name = c_name(structure)
    assert int(compiled[name][0]) == ctypes.sizeof(structure)
    for field, kind in structure._fields_:
        offset, found = compiled[f"{name}.{c_member(field)}"]
        assert int(offset) == getattr(structure, field).offset, field
        assert fits(found, code(kind)), f"{field}: {found}, expected {code(kind)}"


@pytest.mark.parametrize("name", _library._FUNCTIONS)
def test_functions_take_and_give_what_the_header_declares(name, compiled):
    result, arguments = _library._FUNCTIONS[name]
    expected = [code(kind) for kind in (result, *arguments)]
    found = compiled[name]
    assert len(found) == len(expected)
    for place, (one, other) in enumerate(zip(found, expected)):
        assert fits(one, other), f"{place}: {one}, expected {other}"
