"""Names in the Zenoh network of `rmw_zenoh_cpp`: keys of topics, liveliness tokens, attachments.

https://github.com/ros2/rmw_zenoh/blob/rolling/docs/design.md describes them.
"""

import hashlib
import struct
import time
from dataclasses import dataclass

NODE, PUBLISHER, SUBSCRIPTION = "NN", "MP", "MS"
NAME = "hsr8"  # of the node
# Reliability, durability, history, deadline, lifespan, liveliness; empty for the default, which is
# reliable and volatile with a history of 10.
QOS, LATCHED_QOS = "::,10:,:,:,,", ":1:,1:,:,:,,"
GID = 16  # bytes of the identifier of a publisher


@dataclass(frozen=True, slots=True)
class Endpoint:
    """Publisher or subscription of the node.

    Attributes:
        domain: ROS domain.
        session: identifier of the Zenoh session.
        number: number of the endpoint in its node, from 1.
        role: `PUBLISHER` or `SUBSCRIPTION`.
        name: name of the topic.
        kind: type of its messages.
        type_hash: RIHS01 hash of the type.
        latched: whether later subscribers receive the last message.
    """

    domain: int
    session: str
    number: int
    role: str
    name: str
    kind: str
    type_hash: str
    latched: bool = False

    @property
    def key(self) -> str:
        """Key of the messages."""
        return f"{self.domain}/{self.name.strip('/')}/{self._type}"

    @property
    def token(self) -> str:
        """Liveliness token."""
        qos = LATCHED_QOS if self.latched else QOS
        owner = f"{self.session}/0/{self.number}/{self.role}/%/%/{NAME}"
        return f"@ros2_lv/{self.domain}/{owner}/{self.name.replace('/', '%')}/{self._type}/{qos}"

    @property
    def _type(self) -> str:
        package, _, name = self.kind.partition("/msg/")
        return f"{package}::msg::dds_::{name}_/{self.type_hash}"


def node_token(domain: int, session: str) -> str:
    """Return the liveliness token of the node."""
    return f"@ros2_lv/{domain}/{session}/0/0/{NODE}/%/%/{NAME}"


def attachment(endpoint: Endpoint, sequence: int) -> bytes:
    """Return the attachment of a message that is sent now.

    Args:
        endpoint: its publisher.
        sequence: number of the message, from 1.
    """
    gid = hashlib.blake2b(endpoint.token.encode(), digest_size=GID).digest()
    return struct.pack("<qqB", sequence, time.time_ns(), GID) + gid
