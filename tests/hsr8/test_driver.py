import hsr8
from hsr8.measure.registry import METRICS, Metric
from hsr8.recording.columns import Column, Row
from hsr8.recording.rows import TABLES


def test_a_new_column_and_a_new_metric_are_one_entry_each(monkeypatch, tmp_path):
    row = TABLES["ticks"]
    gyro = Column("sensors.gyro", "the gyro again", "rad/s", (3,), name="again")
    monkeypatch.setitem(TABLES, "ticks", Row(row.text, *row.columns, gyro))
    of = Metric("max_gyro_radps", "", of=lambda run: float(abs(run.ticks["again"]).max()))
    monkeypatch.setitem(METRICS, of.name, of)
    settings = {"robot.body": "kinematic", "camera.source": "analytic", "duration": 0.3}
    for out in (None, tmp_path):
        run = hsr8.run("quick", settings=settings, out=out)
        assert run.metrics["max_gyro_radps"] == abs(run.ticks["gyro"]).max()
        assert run.unit("ticks.again") == "rad/s"
