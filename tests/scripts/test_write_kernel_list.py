import pytest
import write_kernel_list

from hsr8.kernel_compilation import LIST, compile_kernels


@pytest.mark.gl
@pytest.mark.timeout(600)
def test_the_list_has_exactly_the_kernels_of_a_run():
    """On a failure: python scripts/write_kernel_list.py."""
    compile_kernels(lambda done, total: None)
    assert write_kernel_list.loaded() == LIST.read_text(encoding="utf-8").splitlines()
