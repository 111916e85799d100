"""Reads an MCAP file by its specification with nothing but Python itself: walks every record, holds every
CRC, length and index against what it says, every message against its schema, and says what is in it."""
import base64
import json
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F


class Content:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, form):
        value, = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return value

    def bytes(self, size):
        self.at += size
        assert self.at <= len(self.data)
        return self.data[self.at - size:self.at]

    def string(self):
        return self.bytes(self.take("I")).decode()

    def pairs(self, key, value):
        inner = Content(self.bytes(self.take("I")))
        pairs = []
        while inner.at < len(inner.data):
            pairs.append((inner.take(key), inner.take(value)))
        return pairs


def records(data, start, end):
    """Offset, opcode and content of each record."""
    while start < end:
        opcode, length = struct.unpack_from("<BQ", data, start)
        assert start + 9 + length <= end
        yield start, opcode, data[start + 9:start + 9 + length]
        start += 9 + length
    assert start == end


def check(value, schema, where):
    """What of JSON Schema the schemas use."""
    kind = schema["type"]
    if kind == "object":
        assert isinstance(value, dict), where
        assert set(value) == set(schema["properties"]), (where, set(value) ^ set(schema["properties"]))
        for name, inner in value.items():
            check(inner, schema["properties"][name], where + "." + name)
    elif kind == "array":
        for inner in value:
            check(inner, schema["items"], where + "[]")
    else:
        types = {"number": (int, float), "integer": int, "string": str, "boolean": bool}
        assert isinstance(value, types[kind]), (where, value)


with open(sys.argv[1], "rb") as file:
    data = file.read()
assert data.startswith(MAGIC) and data.endswith(MAGIC)
footer_start = len(data) - 8 - 29
opcode, length, summary_start, offsets_start, crc = struct.unpack_from("<BQQQI", data, footer_start)
assert (opcode, length) == (FOOTER, 20)
assert crc == zlib.crc32(data[summary_start:len(data) - 12])

schemas, channels, messages, chunks, indexes = {}, {}, [], {}, {}
opcodes = []
for offset, opcode, content in records(data, 8, summary_start):
    opcodes.append(opcode)
    take = Content(content)
    if opcode == CHUNK:
        first, last, size, crc = take.take("Q"), take.take("Q"), take.take("Q"), take.take("I")
        assert take.string() == "" and take.take("Q") == size
        body = take.bytes(size)
        assert take.at == len(content) and crc == zlib.crc32(body)
        times = []
        for at, inner, content in records(body, 0, size):
            take = Content(content)
            if inner == SCHEMA:
                number = take.take("H")
                schemas[number] = (take.string(), take.string(), json.loads(take.bytes(take.take("I"))), content)
            elif inner == CHANNEL:
                number, schema = take.take("H"), take.take("H")
                assert schema in schemas
                channels[number] = (take.string(), take.string(), schema, content)
            else:
                assert inner == MESSAGE
                channel, sequence, time = take.take("H"), take.take("I"), take.take("Q")
                assert take.take("Q") == time
                times.append((channel, time, at))
                messages.append((channels[channel][0], time, json.loads(content[take.at:])))
                check(messages[-1][2], schemas[channels[channel][2]][2], channels[channel][0])
        assert [time for _, time, _ in times] == sorted(time for _, time, _ in times)
        assert not times or (first, last) == (times[0][1], times[-1][1])
        chunks[offset] = (first, last, size, times)
    elif opcode == MESSAGE_INDEX:
        channel = take.take("H")
        chunk = max(chunks)
        assert take.pairs("Q", "Q") == [(time, at) for c, time, at in chunks[chunk][3] if c == channel]
        indexes.setdefault(chunk, {})[channel] = offset
assert opcodes[0] == HEADER and opcodes[-1] == DATA_END

groups = {}
for offset, opcode, content in records(data, summary_start, offsets_start):
    groups.setdefault(opcode, []).append(offset)
    take = Content(content)
    if opcode == SCHEMA:
        assert schemas[take.take("H")][3] == content
    elif opcode == CHANNEL:
        assert channels[take.take("H")][3] == content
    elif opcode == STATISTICS:
        assert take.take("Q") == len(messages)
        assert (take.take("H"), take.take("I")) == (len(schemas), len(channels))
        assert (take.take("I"), take.take("I"), take.take("I")) == (0, 0, len(chunks))
        assert (take.take("Q"), take.take("Q")) == (messages[0][1], messages[-1][1])
        counts = {channels[c][0]: n for c, n in take.pairs("H", "Q")}
    elif opcode == CHUNK_INDEX:
        first, last, start, length = (take.take("Q") for _ in range(4))
        assert chunks[start][:2] == (first, last)
        assert struct.unpack_from("<BQ", data, start) == (CHUNK, length - 9)
        assert dict(take.pairs("H", "Q")) == indexes[start]
        take.take("Q")
        assert (take.string(), take.take("Q"), take.take("Q")) == ("", chunks[start][2], chunks[start][2])
assert len(groups[CHUNK_INDEX]) == len(chunks)
for offset, opcode, content in records(data, offsets_start, footer_start):
    group, start, length = struct.unpack("<BQQ", content)
    assert opcode == SUMMARY_OFFSET and start == groups[group][0]
    assert [o for o, _, _ in records(data, start, start + length)] == groups[group]

for topic, count in counts.items():
    assert count == sum(t == topic for t, _, _ in messages)
    print(topic, count, next(schemas[c[2]][0] for c in channels.values() if c[0] == topic))
for topic in ("/scan", "/map"):
    cloud = [message for t, _, message in messages if t == topic][-1]
    assert [f["type"] for f in cloud["fields"]] == [7] * 4 and cloud["point_stride"] == 16
    points = list(struct.iter_unpack("<4f", base64.b64decode(cloud["data"], validate=True)))
    print("points" + topic, len(points), *(sum(column) for column in zip(*points)))
pose = [message for t, _, message in messages if t == "/sensor_pose"][-1]["pose"]
print("pose", *pose["position"].values(), *pose["orientation"].values())
print("time", messages[-1][1])
print("end", [message for t, _, message in messages if t == "/log"][-1]["message"])
