"""Reads a binary PLY or PCD file of points and says what is in it, with nothing but Python itself:
the number of points, the bytes behind them, and of each field its smallest, its largest and the sum of its values."""
import struct
import sys

PLY_TYPES = {"float": "f", "uint": "I"}
PCD_TYPES = {("F", "4"): "f", ("U", "4"): "I"}


def read_header(file):
    """The names of the fields, their struct codes, and the number of points."""
    first = file.readline().decode().strip()
    if first == "ply":
        lines = [line.split() for line in iter(lambda: file.readline().decode().strip(), "end_header")]
        assert ["format", "binary_little_endian", "1.0"] in lines
        points = next(int(line[2]) for line in lines if line[:2] == ["element", "vertex"])
        properties = [line for line in lines if line[0] == "property"]
        return [p[2] for p in properties], [PLY_TYPES[p[1]] for p in properties], points
    assert first.startswith("# .PCD v0.7"), first
    header = {}
    while "DATA" not in header:
        words = file.readline().decode().split()
        header[words[0]] = words[1:]
    assert header["DATA"] == ["binary"] and header["VERSION"] == ["0.7"]
    points = int(header["POINTS"][0])
    assert points == int(header["WIDTH"][0]) * int(header["HEIGHT"][0])
    assert set(header["COUNT"]) == {"1"}
    return header["FIELDS"], [PCD_TYPES[t] for t in zip(header["TYPE"], header["SIZE"])], points


with open(sys.argv[1], "rb") as file:
    names, codes, count = read_header(file)
    body = file.read()
row = struct.Struct("<" + "".join(codes))
end = count * row.size
assert len(body) >= end, (len(body), count, row.size)
columns = list(zip(*row.iter_unpack(body[:end])))
print("points", count)
print("bytes_left", len(body) - end)
for name, column in zip(names, columns):
    print(name, min(column), max(column), sum(column))
