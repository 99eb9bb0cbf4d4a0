"""Reads a .pent file with numpy alone: python3 read_pent.py FILE prints what is in it."""
import sys
import numpy as np

TYPES = dict(char="i1", uchar="u1", short="i2", ushort="u2", int="i4", uint="u4", float="f4", double="f8")

def read_pent(path):
    """Returns (comments by their first word, arrays of records by element)."""
    header, body = open(path, "rb").read().split(b"end_header\n", 1)
    comments, elements, arrays = {}, [], {}
    for words in (line.split() for line in header.decode().splitlines()):
        if words[0] == "format":
            is_ascii = words[1] == "ascii"
        elif words[0] == "comment" and len(words) > 1:
            comments[words[1]] = " ".join(words[2:])
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append((words[2], "<" + TYPES[words[1]]))
    for name, count, fields in elements:
        if is_ascii:
            *rows, body = body.split(b"\n", count)
            arrays[name] = np.array([tuple(row.split()) for row in rows], dtype=fields)
        else:
            arrays[name] = np.frombuffer(body, dtype=fields, count=count)
            body = body[arrays[name].nbytes:]
    return comments, arrays

if __name__ == "__main__":
    print(*read_pent(sys.argv[1]), sep="\n")
