"""A reader of MCAP files by the format's specification, for the records that profile `ros1` needs.

Independent of the writer: it checks every length, checksum, index and count that the file states.
"""
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 11, 14, 15


class Fields:
    """Reads the fields of a record's content in their order."""

    def __init__(self, content):
        self.content, self.at = content, 0

    def number(self, code):
        value, = struct.unpack_from("<" + code, self.content, self.at)
        self.at += struct.calcsize("<" + code)
        return value

    def take(self, size):
        assert self.at + size <= len(self.content), "a field is longer than its record"
        self.at += size
        return self.content[self.at - size:self.at]

    def text(self):
        return self.take(self.number("I")).decode()

    def pairs(self, key, value):
        inner, result = Fields(self.take(self.number("I"))), {}
        while inner.at < len(inner.content):
            name = inner.text() if key == "text" else inner.number(key)
            result[name] = inner.text() if value == "text" else inner.number(value)
        return result

    def rest(self):
        return self.take(len(self.content) - self.at)


def records(data, begin, end):
    """Kind, content and place of each record."""
    while begin < end:
        kind, size = struct.unpack_from("<BQ", data, begin)
        assert begin + 9 + size <= end, "a record is longer than the file"
        yield kind, data[begin + 9:begin + 9 + size], begin
        begin += 9 + size


class Mcap:
    """Everything in a file: profile, schemas, channels, messages (channel, time, bytes) and statistics."""

    def __init__(self, path):
        data = path.read_bytes()
        assert data.startswith(MAGIC) and data.endswith(MAGIC)
        self.schemas, self.channels, self.messages, self.chunks, self.indexed = {}, {}, [], {}, 0
        summary = self.read_footer(data)
        for kind, content, place in records(data, len(MAGIC), len(data) - len(MAGIC)):
            if kind == HEADER:
                self.profile = Fields(content).text()
            elif kind == CHUNK:
                self.read_chunk(content, place)
            elif kind == MESSAGE_INDEX:
                self.check_index(content)
            elif kind == DATA_END:
                crc = Fields(content).number("I")
                assert crc in (0, zlib.crc32(data[:place])), "checksum of the data"
                assert summary == place + 9 + len(content), "the summary follows the data"
            elif kind == STATISTICS:
                self.read_statistics(content)
            elif kind == CHUNK_INDEX:
                self.check_chunk_index(content)
        assert self.indexed == len(self.messages), "each message has an index"

    @staticmethod
    def read_footer(data):
        begin = len(data) - len(MAGIC) - 9 - 20
        (kind, content, _), = records(data, begin, len(data) - len(MAGIC))
        assert kind == FOOTER
        summary, _, crc = struct.unpack("<QQI", content)
        assert crc == zlib.crc32(data[summary:len(data) - len(MAGIC) - 4]), "checksum of the summary"
        return summary

    def read_chunk(self, content, place):
        fields = Fields(content)
        first, last, size, crc = (fields.number(code) for code in "QQQI")
        assert fields.text() == "", "compression"
        self.chunk = fields.take(fields.number("Q"))
        assert len(self.chunk) == size and crc in (0, zlib.crc32(self.chunk))
        self.chunks[place] = (first, last)
        for kind, inner, _ in records(self.chunk, 0, size):
            at = Fields(inner)
            if kind == SCHEMA:
                number = at.number("H")
                self.schemas[number] = (at.text(), at.text(), at.text())
            elif kind == CHANNEL:
                number = at.number("H")
                self.channels[number] = (at.number("H"), at.text(), at.text(), at.pairs("text", "text"))
            elif kind == MESSAGE:
                channel, _, time, _ = (at.number(code) for code in "HIQQ")
                assert first <= time <= last and channel in self.channels
                self.messages.append((channel, time, at.rest()))

    def check_index(self, content):
        fields = Fields(content)
        channel, entries = fields.number("H"), Fields(fields.take(fields.number("I")))
        while entries.at < len(entries.content):
            time, offset = entries.number("Q"), entries.number("Q")
            kind, size = struct.unpack_from("<BQ", self.chunk, offset)
            message = Fields(self.chunk[offset + 9:offset + 9 + size])
            assert kind == MESSAGE and message.number("H") == channel
            message.number("I")
            assert message.number("Q") == time
            self.indexed += 1

    def check_chunk_index(self, content):
        fields = Fields(content)
        first, last, place = (fields.number("Q") for _ in range(3))
        assert self.chunks[place] == (first, last)

    def read_statistics(self, content):
        fields = Fields(content)
        self.statistics = [fields.number(code) for code in "QHIIIIQQ"]
        self.counts = fields.pairs("H", "Q")
