"""Keys, tokens and attachments are those of an independent client of `rmw_zenoh_cpp`."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("zenoh_ros2_sdk")
from zenoh_ros2_sdk.attachment import Attachment
from zenoh_ros2_sdk.entity import EndpointEntity, EntityKind, NodeEntity
from zenoh_ros2_sdk.keyexpr import (
    endpoint_liveliness_keyexpr,
    node_liveliness_keyexpr,
    topic_keyexpr,
)
from zenoh_ros2_sdk.qos import QosDurability, QosProfile
from zenoh_ros2_sdk.utils import ros2_to_dds_type

from hsr8.export.topics import TOPICS
from hsr8.ros.graph import NAME, PUBLISHER, SUBSCRIPTION, Endpoint, attachment, node_token

SESSION, HASH = "10f0baf12b148303c89d021660723ce9", "RIHS01_00"
endpoints = st.builds(
    lambda topic, domain, number, role: Endpoint(
        domain, SESSION, number, role, topic.name, topic.kind, HASH, topic.latched
    ),
    st.sampled_from(TOPICS),
    st.integers(0, 232),
    st.integers(1, 99),
    st.sampled_from([PUBLISHER, SUBSCRIPTION]),
)


@given(endpoints)
def test_keys_and_tokens(endpoint):
    node = NodeEntity(endpoint.domain, SESSION, 0, NAME)
    latched = QosProfile(durability=QosDurability.TRANSIENT_LOCAL, history_depth=1)
    entity = EndpointEntity(
        node,
        endpoint.number,
        EntityKind(endpoint.role),
        endpoint.name,
        ros2_to_dds_type(endpoint.kind),
        HASH,
        (latched if endpoint.latched else QosProfile()).encode(),
    )
    assert endpoint.token == endpoint_liveliness_keyexpr(entity)
    assert node_token(endpoint.domain, SESSION) == node_liveliness_keyexpr(node)
    kind = ros2_to_dds_type(endpoint.kind)
    assert endpoint.key == topic_keyexpr(endpoint.domain, endpoint.name, kind, HASH)


@given(endpoints, st.integers(1, 2**60))
def test_attachments(endpoint, sequence):
    sent = attachment(endpoint, sequence)
    read = Attachment.from_bytes(sent)
    assert read.sequence_id == sequence
    assert read.to_bytes() == sent
    assert len(read.gid) == 16
