from hsr8.recorder.record_buffer import RecordBuffer


def test_records_are_taken_in_order_once_per_period(fake):
    block = RecordBuffer(0.1)
    records = [fake.record(0.02 * k) for k in range(12)]
    assert [block.add(record) for record in records[:6]] == [False] * 5 + [True]
    assert block.take() == records[:6]
    assert block.take() == []


def test_a_period_begins_with_its_first_record(fake):
    block = RecordBuffer(0.1)
    block.add(fake.record(0.0))
    block.take()
    assert [block.add(fake.record(t)) for t in (5.0, 5.08, 5.1)] == [False, False, True]
