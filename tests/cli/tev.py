"""Stands in for the viewer tev: takes pictures by its protocol (src/cli/tev.h), and checks every packet.

    tev.py listen PORT_FILE FOLDER      takes one connection to its end; writes what it was shown into FOLDER: `log`, a line
                                        for each picture created and each time its last row was updated, and a file of
                                        floats for each channel
    tev.py ignore|refuse PORT_FILE      takes a connection and reads nothing; or closes each at once
    tev.py same FOLDER FILE.exr         whether the channels are those of an uncompressed OpenEXR file
"""
import array
import os
import socket
import struct
import sys
import time


class Packet:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, form):
        values = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return values[0] if len(values) == 1 else values

    def text(self):
        end = self.data.index(b"\0", self.at)
        text = self.data[self.at:end].decode()
        self.at = end + 1
        return text


def packets(connection):
    stream = connection.makefile("rb")
    while head := stream.read(4):
        length, = struct.unpack("<I", head)
        data = stream.read(length - 4)
        assert len(data) == length - 4, "a packet that ends early"
        yield Packet(data)


class Viewer:
    def __init__(self, log):
        self.log, self.pictures = log, {}

    def create(self, packet):
        name, (width, height, count) = packet.text(), packet.take("iii")
        channels = {packet.text(): array.array("f", bytes(4 * width * height)) for _ in range(count)}
        assert packet.at == len(packet.data) and len(channels) == count
        self.pictures[name] = width, height, channels
        print("create", name, f"{width}x{height}", *sorted(channels), file=self.log, flush=True)

    def update(self, packet):
        name, count = packet.text(), packet.take("i")
        assert count == 1
        channel = packet.text()
        x, y, width, height = packet.take("iiii")
        assert packet.take("qq") == (0, 1), "channels that are not floats one after the other"
        floats = array.array("f", packet.data[packet.at:])
        whole_width, whole_height, channels = self.pictures[name]
        assert x == 0 and width == whole_width and y + height <= whole_height and len(floats) == width * height
        channels[channel][y * width:(y + height) * width] = floats
        if y + height == whole_height and channel == list(channels)[-1]:
            print("shown", name, file=self.log, flush=True)

    def take(self, packet):
        kind, _ = packet.take("BB")
        {4: self.create, 6: self.update}[kind](packet)


def serve(what, port_file, folder):
    with socket.create_server(("127.0.0.1", 0)) as server:
        if what == "ignore":
            server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        with open(port_file + ".new", "w") as file:
            file.write(str(server.getsockname()[1]))
        os.rename(port_file + ".new", port_file)
        connection, _ = server.accept()
        while what == "refuse":
            connection.close()
            connection, _ = server.accept()
        while what == "ignore":
            time.sleep(1)
        with open(os.path.join(folder, "log"), "w") as log, connection:
            viewer = Viewer(log)
            for packet in packets(connection):
                viewer.take(packet)
    for _, _, channels in viewer.pictures.values():
        for name, floats in channels.items():
            with open(os.path.join(folder, name), "wb") as file:
                floats.tofile(file)


def exr_channels(path):
    """Of a file of scan lines without compression, all floats."""
    with open(path, "rb") as file:
        data = file.read()
    packet, attributes = Packet(data), {}
    assert packet.take("II") == (20000630, 2)
    while name := packet.text():
        packet.text()
        size = packet.take("I")
        attributes[name] = Packet(data[packet.at:packet.at + size])
        packet.at += size
    left, top, right, bottom = attributes["dataWindow"].take("iiii")
    assert attributes["compression"].take("B") == 0
    width, height, names = right - left + 1, bottom - top + 1, []
    while name := attributes["channels"].text():
        assert attributes["channels"].take("iIii")[0] == 2
        names.append(name)
    channels = {name: array.array("f") for name in names}
    for offset in packet.take(f"{height}Q"):
        row = Packet(data[offset:])
        row.take("iI")
        for name in names:
            channels[name].frombytes(row.data[row.at:row.at + 4 * width])
            row.at += 4 * width
    return channels


def is_same(folder, path):
    shown = set(os.listdir(folder)) - {"log"}
    channels = exr_channels(path)
    if shown != set(channels):
        print("channels", sorted(shown), "and", sorted(channels))
        return False
    for name, floats in channels.items():
        with open(os.path.join(folder, name), "rb") as file:
            if file.read() != floats.tobytes():
                print(name, "differs")
                return False
    return True


if sys.argv[1] == "same":
    sys.exit(not is_same(*sys.argv[2:]))
serve(*(sys.argv[1:] + [None])[:3])
