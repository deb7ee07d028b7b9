# hsr8 with compiled kernels, see docs/docker.md.
FROM python:3.12.8-slim-bookworm AS build
WORKDIR /src
COPY . .
RUN sed -E '/--hash/d; s/ *\\$//' requirements.lock >/constraints.txt
ENV PIP_CONSTRAINT=/constraints.txt
RUN python -m venv /opt/hsr8 && /opt/hsr8/bin/pip install --no-cache-dir .

FROM python:3.12.8-slim-bookworm
RUN apt-get update \
    && apt-get install -y --no-install-recommends libegl1 libgl1 libgomp1 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/hsr8 /opt/hsr8
# Software rendering, and kernels for every processor with AVX2, not only that of the build.
ENV PATH=/opt/hsr8/bin:$PATH \
    MUJOCO_GL=egl \
    LIBGL_ALWAYS_SOFTWARE=1 \
    NUMBA_CACHE_DIR=/var/cache/hsr8 \
    NUMBA_CPU_NAME=x86-64-v3 \
    NUMBA_CPU_FEATURES=
RUN useradd --create-home hsr8 && install -d -o hsr8 /var/cache/hsr8 /data
USER hsr8
RUN hsr8 doctor --compile && chmod -R a+rwX /var/cache/hsr8
WORKDIR /data
ENTRYPOINT ["hsr8"]
CMD ["--help"]
