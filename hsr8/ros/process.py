"""Publishing process of live topics: it makes the messages and holds the Zenoh session."""

import json
import re
import signal
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.export.bag import require_rosbags
from hsr8.export.topics import PIXELS, TOPICS, Rows, Setup, Topic, Translator
from hsr8.recording.recorded import jpeg_of
from hsr8.ros.graph import PUBLISHER, SUBSCRIPTION, Endpoint, attachment, node_token
from hsr8.ros.inputs import DRIVEN, INPUTS, Command, Input

HERE = "tcp/127.0.0.1:7447"  # where nodes of ROS 2 look for their router
ANYWHERE = "tcp/127.0.0.1:0"  # at any free port of this machine
QUALITY = 75  # JPEG quality of the compressed images, from 0 to 100


@dataclass(frozen=True, slots=True)
class Network:
    """Domain and endpoints of the node in a network.

    Attributes:
        domain: ROS domain.
        connect: endpoint to connect to; empty for none.
        listen: endpoint to listen on; empty for the default, on this machine only.
        drive: whether to receive commands.
    """

    domain: int = 0
    connect: str = ""
    listen: str = ""
    drive: bool = False

    def config(self) -> Any:
        """Return the configuration of Zenoh.

        The session is a router, which nodes of ROS 2 expect. It is a peer if it only connects to
        another router.

        Raises:
            zenoh.ZError: an endpoint is invalid.
        """
        import zenoh  # noqa: PLC0415  an extra

        config = zenoh.Config()
        single = bool(self.connect) and not self.listen
        config.insert_json5("mode", '"peer"' if single else '"router"')
        listen = self.listen or (ANYWHERE if single else HERE)
        config.insert_json5("listen/endpoints", json.dumps([listen]))
        config.insert_json5("connect/endpoints", json.dumps([self.connect] if self.connect else []))
        config.insert_json5("scouting/multicast/enabled", "false")
        config.insert_json5("timestamping/enabled", "true")  # for latched messages
        return config


class Objects(dict[str, Any]):
    """Columns of the objects in one row."""

    @property
    def parents(self) -> NDArray[np.intp]:
        """Row of each object, which is the first."""
        return np.zeros(len(next(iter(self.values()))), np.intp)


def rows_of(values: Mapping[str, Any]) -> Rows:
    """Return the values of one row by column as rows; a mapping has the columns of its objects."""
    return {name: _column(value) for name, value in values.items()}


def _column(value: Any) -> Any:
    """Return the column of one row with a value."""
    if isinstance(value, Mapping):
        return Objects({name: _array(column) for name, column in value.items()})
    if value is None or isinstance(value, bytes):
        return [value]
    return np.asarray(value)[None]


def _array(column: Any) -> NDArray[Any]:
    return column if isinstance(column, np.ndarray) else np.array(column, object)


class Session:
    """Node with its publishers and subscriptions.

    Args:
        network: domain and endpoints.
        translator: makes the messages.

    Attributes:
        count: number of messages published.
        commands: latest command of each topic that is not yet taken.
        refused: latest refusal of each topic that is not yet taken.

    Raises:
        zenoh.ZError: the session cannot be opened.
    """

    def __init__(self, network: Network, translator: Translator) -> None:
        import zenoh  # noqa: PLC0415  an extra

        self._zenoh, self._network, self._translator = zenoh, network, translator
        self.count = 0
        self.commands: dict[str, Command] = {}
        self.refused: dict[str, str] = {}
        self._store, self._joints = translator.messages.store, translator.setup.robot.joints
        self._sequence: dict[Topic, int] = {}
        self._session: Any = zenoh.open(network.config())
        self._zid = str(self._session.info.zid())
        self._endpoints: list[Endpoint] = []
        self._declared = [self._token(node_token(network.domain, self._zid))]
        self._publishers = {
            topic: self._publisher(topic)
            for topic in TOPICS
            if not (network.drive and topic.name in DRIVEN)
        }
        for source in INPUTS if network.drive else ():
            self._subscribe(source)

    def publish(self, table: str, values: Mapping[str, Any]) -> None:
        """Publish the messages of a row of a table."""
        for topic, messages in self._translator.translate(table, rows_of(values)):
            if topic not in self._publishers:
                continue
            endpoint, publisher = self._publishers[topic]
            for _, message in messages:
                number = self._sequence[topic] = self._sequence.get(topic, 0) + 1
                publisher.put(message, attachment=attachment(endpoint, number))
                self.count += 1

    def close(self) -> None:
        """Leave the network."""
        self._session.close()

    def _token(self, key: str) -> Any:
        return self._session.liveliness().declare_token(key)

    def _endpoint(self, role: str, name: str, kind: str, *, latched: bool = False) -> Endpoint:
        number, type_hash = len(self._endpoints) + 1, self._store.hash_rihs01(kind)
        endpoint = Endpoint(
            self._network.domain, self._zid, number, role, name, kind, type_hash, latched
        )
        self._endpoints.append(endpoint)
        self._declared.append(self._token(endpoint.token))
        return endpoint

    def _publisher(self, topic: Topic) -> tuple[Endpoint, Any]:
        endpoint = self._endpoint(PUBLISHER, topic.name, topic.kind, latched=topic.latched)
        if not topic.latched:
            return endpoint, self._session.declare_publisher(endpoint.key)
        extension = self._zenoh.ext
        return endpoint, extension.declare_advanced_publisher(
            self._session,
            endpoint.key,
            cache=extension.CacheConfig(max_samples=1),
            publisher_detection=True,
        )

    def _subscribe(self, source: Input) -> None:
        endpoint = self._endpoint(SUBSCRIPTION, source.name, source.kind)

        def receive(sample: Any) -> None:  # in a thread of Zenoh
            try:
                command = source.read(self._store, sample.payload.to_bytes(), self._joints)
            except ValueError as error:
                self.refused[source.name] = f"{source.name}: message refused: {error}"
            else:
                self.commands[source.name] = command

        self._declared.append(self._session.declare_subscriber(endpoint.key, receive))


def serve(network: Network, setup: Setup, ticks: Connection, parent: Connection) -> None:
    """Publish the rows of ticks until their sender closes or ends.

    The process sends the parent ``ready`` or ``failed``, then commands and refusals, and at the
    end the number of messages.

    Args:
        network: domain and endpoints.
        setup: constants of the run.
        ticks: sends lists of table and row, one for each tick.
        parent: receives the answers.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides when the run ends
    _, messages = require_rosbags()
    with suppress(BrokenPipeError):  # the parent ended
        try:
            session = Session(network, Translator(messages, setup))
        except Exception as error:  # mostly zenoh.ZError; the parent reports any
            parent.send(("failed", re.sub(r" at \S+\.rs:\d+\.?", "", str(error))))
            return
        parent.send(("ready", ""))
        with suppress(EOFError):
            while True:
                _publish(session, ticks.recv())
                for taken, kind in ((session.commands, "command"), (session.refused, "refused")):
                    for name in tuple(taken):
                        parent.send((kind, (name, taken.pop(name))))
        session.close()
        parent.send(("published", session.count))


def _publish(session: Session, rows: list[tuple[str, Mapping[str, Any]]]) -> None:
    """Publish the rows of a tick; images also compressed."""
    for table, values in rows:
        session.publish(table, values)
        if table == PIXELS:
            jpeg = jpeg_of(values["image"], QUALITY)
            session.publish("images", {**values, "jpeg": jpeg})
