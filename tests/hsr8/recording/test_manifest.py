from hsr8.recording import manifest as module
from hsr8.recording.manifest import code_digest


def test_the_digest_is_of_what_shapes_a_result(tmp_path, monkeypatch):
    files = dict(module._files())
    assert {"hsr8/simulation/loop.py", "walking/engine.py", "models/hsr8/hsr8.xml"} <= files.keys()
    assert not any(
        name.startswith(("hsr8/cli", "hsr8/show", "hsr8/measure/registry")) for name in files
    )
    before = code_digest.__wrapped__()
    assert code_digest.__wrapped__() == before
    changed = tmp_path / "loop.py"
    changed.write_text("")
    monkeypatch.setattr(module, "_files", lambda: [*files.items(), ("hsr8/new.py", changed)])
    assert code_digest.__wrapped__() != before
