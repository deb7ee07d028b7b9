"""Topics: rows one by one give the messages of all rows at once, and types are those of ROS."""

from collections import defaultdict
from importlib import import_module

import numpy as np
import pytest

from hsr8.export.topics import START, TF, TOPICS, Setup, Translator
from hsr8.robots.loaded import load_robot
from hsr8.ros.inputs import INPUTS

pytest.importorskip("rosbags")
from hsr8.export.bag import require_rosbags

# Of tf2_msgs/msg/TFMessage, as nodes of Jazzy with rmw_zenoh_cpp have it in their tokens.
TF_HASH = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"
KINDS = sorted({topic.kind for topic in (*TOPICS, *INPUTS)} - {TF})


def translated(run, batches):
    """Return times and messages of all topics of batches of tables and rows."""
    _, messages = require_rosbags()
    setup = Setup.of(load_robot("hsr8"), run.scenario().camera.pinhole, "<robot/>")
    translator, sent = Translator(messages, setup), defaultdict(list)
    for table, rows in batches:
        for topic, contents in translator.translate(table, rows):
            sent[topic.name] += contents
    return sent


def test_rows_one_by_one_give_the_contentsof_all_at_once(run):
    tables = {name: getattr(run, name) for name in ("ticks", "frames", "records")}
    start = START, {"time": np.zeros(1), "start": np.array([[0.1, -0.2, 0.3]])}
    rows = [
        (table["time"][k], rank, name, table.rows(k, k + 1))
        for rank, (name, table) in enumerate(tables.items())
        for k in range(len(table))
    ]
    rows.sort(key=lambda row: row[:2])
    single = translated(run, [start, *(row[2:] for row in rows)])
    whole = translated(run, [start, *tables.items()])
    assert {len(messages) > 0 for messages in whole.values()} == {True}
    assert single == whole


@pytest.mark.parametrize("kind", KINDS)
def test_type_hashes_are_those_of_an_independent_implementation(kind):
    interfaces = pytest.importorskip("ros2_pyterfaces.core")
    _, messages = require_rosbags()
    package, _, name = kind.split("/")
    module = import_module(f"ros2_pyterfaces.core.{package}.msg")
    assert messages.store.hash_rihs01(kind) == interfaces.hash_rihs01(getattr(module, name))


def test_the_type_hash_of_transforms_is_the_published_one():
    _, messages = require_rosbags()
    assert messages.store.hash_rihs01(TF) == TF_HASH
