"""LCM's UDP multicast in a page of Python, for Debian 12, which has no python3-lcm. Where LCM's own module is
installed, lcm.LCM(url) does the same and more. Messages of nextview are never large enough to be cut into
fragments, so fragments are left out."""

import queue
import socket
import struct
import threading
import urllib.parse

SHORT_MESSAGE = 0x4C433032  # "LC02": this, a number, the channel, a NUL, the encoded message
LARGEST_DATAGRAM = 65535


class Lcm:
    """udpm://GROUP:PORT?ttl=N, as nextview prints it."""

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        if parts.scheme != "udpm" or not parts.hostname or not parts.port:
            raise ValueError(f"{url!r} is not like udpm://239.255.76.67:7667?ttl=0")
        ttl = int(urllib.parse.parse_qs(parts.query).get("ttl", ["0"])[0])
        self._to = (parts.hostname, parts.port)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2 << 20)
        self._socket.bind(self._to)
        membership = struct.pack("4s4s", socket.inet_aton(parts.hostname), socket.inet_aton("0.0.0.0"))
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
        self._sent = 0
        self._handlers = {}
        self._received = queue.Queue()
        # Taken in at once: while a handler works, the socket would overflow.
        threading.Thread(target=self._receive, daemon=True).start()

    def subscribe(self, channel, handler):
        """handler(channel, bytes) is called by handle()."""
        self._handlers[channel] = handler

    def publish(self, channel, data):
        header = struct.pack(">II", SHORT_MESSAGE, self._sent & 0xFFFFFFFF)
        self._socket.sendto(header + channel.encode() + b"\0" + data, self._to)
        self._sent += 1

    def handle(self, timeout_s):
        """Waits for one message and hands it on; False when none came."""
        try:
            channel, data = self._received.get(timeout=timeout_s)
        except queue.Empty:
            return False
        self._handlers[channel](channel, data)
        return True

    def _receive(self):
        while True:
            datagram = self._socket.recv(LARGEST_DATAGRAM)
            end = datagram.find(b"\0", 8)
            if end < 0 or struct.unpack(">I", datagram[:4])[0] != SHORT_MESSAGE:
                continue
            channel = datagram[8:end].decode("ascii", "replace")
            if channel in self._handlers:
                self._received.put((channel, datagram[end + 1:]))
