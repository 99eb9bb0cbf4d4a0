"""Reads a .pent file with numpy alone: python3 read_pent.py FILE prints what is in it."""
import sys
import numpy as np

TYPES = dict(char="i1", uchar="u1", short="i2", ushort="u2", int="i4", uint="u4", float="f4", double="f8")


def read_pent(path):
    """Returns (comments, elements): comments by their first word; arrays of records by element."""
    data = open(path, "rb").read()
    header, body = data.split(b"end_header\n", 1)
    comments, elements, arrays = {}, [], {}
    for line in header.decode().splitlines():
        words = line.split()
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
            lines = body.split(b"\n", count)
            rows, body = lines[:count], lines[count]
            arrays[name] = np.array([tuple(row.split()) for row in rows], dtype=fields)
        else:
            arrays[name] = np.frombuffer(body, dtype=fields, count=count)
            body = body[arrays[name].nbytes:]
    return comments, arrays


if __name__ == "__main__":
    comments, arrays = read_pent(sys.argv[1])
    print(*comments.items(), *((k, len(a), a.dtype.names) for k, a in arrays.items()), sep="\n")
