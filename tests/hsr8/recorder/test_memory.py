from hsr8.recorder.recorder import Memory
from hsr8.recorder.table import Table


def test_the_columns_of_all_batches_are_kept(fake, tables_of):
    columns = {"records": ("time", "robot"), "frames": ("pose",), "seconds": ("time",)}
    memory = Memory(columns)
    times = (0.0, 0.02, 0.04)
    for time in times:
        frame = fake.frame(time) if time else None
        batch = tables_of([fake.record(time, (time, 0.0, 0.0), frame=frame)])
        memory.add({name: table for name, table in batch.items() if len(table)})
    tables = memory.tables()
    assert all(isinstance(table, Table) for table in tables.values())
    assert {name: tuple(table) for name, table in tables.items() if len(table)} == {
        "records": ("time", "robot"),
        "frames": ("pose",),
    }
    assert tables["records"]["robot"][:, 0].tolist() == list(times)
    assert len(tables["frames"]["pose"]) == 2
    assert len(tables["seconds"]["time"]) == 0
