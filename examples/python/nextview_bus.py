"""A place on the bus of a run, as lcmtypes/bus.h has it: messages of one run, each key once, and what was
published is sent again, the same bytes, to whoever asks for it."""

import pathlib
import sys

import lcm_udpm

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "lcmtypes"))
from program_version import program_version  # noqa: E402,F401  (for the programs beside this file)

try:
    import nextview
except ImportError:
    sys.exit("the message types are missing: in nextview's folder type\n"
             "  lcm-gen -p --ppath examples/python lcmtypes/*.lcm")

NEVER_KEPT = ("NEXTVIEW_REQUEST", "NEXTVIEW_STATUS", "NEXTVIEW_TIMING", "NEXTVIEW_MAP_BLOCKS")


def channel_of(message_type):
    """map_blocks_t travels on NEXTVIEW_MAP_BLOCKS, and so on."""
    return "NEXTVIEW_" + message_type.__name__[:-len("_t")].upper()


def key_of(message):
    return tuple(getattr(message, name, 0) for name in ("view", "attempt", "part"))


class Bus:
    def __init__(self, url, run, role):
        self._run = int(run)
        self._role = role
        self._lcm = lcm_udpm.Lcm(url)
        self._published = {}  # channel -> key -> bytes
        self._seen = set()
        self._on_missing = lambda request: None
        self.on(nextview.request_t, self._answer)

    def on(self, message_type, handler):
        """handler(message) gets every message of this run of the type."""
        def take(channel, data):
            try:
                message = message_type.decode(data)
            except Exception:  # of another type, or broken: whatever the generated code says
                return
            key = (channel, *key_of(message))
            if message.run != self._run or key in self._seen:
                return
            if channel not in NEVER_KEPT:
                self._seen.add(key)
            handler(message)
        self._lcm.subscribe(channel_of(message_type), take)

    def on_missing(self, handler):
        """handler(request) gets requests for what has not been published here."""
        self._on_missing = handler

    def publish(self, message):
        message.run = self._run
        channel = channel_of(type(message))
        data = message.encode()
        if channel not in NEVER_KEPT:
            self._published.setdefault(channel, {})[key_of(message)] = data
        self._lcm.publish(channel, data)

    def request(self, message_type, view=0, attempt=0):
        """Asks whoever publishes it for a message of a view; attempt 0: all there are."""
        request = nextview.request_t()
        request.view = view
        request.attempt = attempt
        request.wanted_channel = channel_of(message_type)
        request.asker = self._role
        self.publish(request)

    def handle(self, timeout_s):
        return self._lcm.handle(timeout_s)

    def _answer(self, request):
        if request.asker == self._role:
            return
        found = [data for key, data in sorted(self._published.get(request.wanted_channel, {}).items())
                 if key[0] == request.view and request.attempt in (0, key[1])]
        for data in found:
            self._lcm.publish(request.wanted_channel, data)
        if not found:
            self._on_missing(request)
