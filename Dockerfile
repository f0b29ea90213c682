# Two images from one file: `poise-cli` (the command alone) and `poise` (the server; the default).
#
#   docker build -t poise .                      docker build -t poise-cli --target poise-cli .
#
# deploy/README.md tells how to run them; scripts/container builds and tries both with podman.
ARG BASE=debian:bookworm-slim

# Packages come in layers of their own: a change of the sources does not fetch them again.
FROM ${BASE} AS tools-cli
WORKDIR /src
COPY scripts/environment scripts/install scripts/
RUN scripts/install --cli && rm -rf /var/lib/apt/lists/*

FROM tools-cli AS tools
RUN scripts/install --build && rm -rf /var/lib/apt/lists/*

FROM tools-cli AS build-cli
COPY . .
RUN --mount=type=cache,target=/root/.cache/ccache \
    scripts/install --cli \
    && scripts/build release --target poise -DPOISE_BUILD_SERVER=OFF -DPOISE_BUILD_TESTS=OFF \
    && cmake --install build/release --strip --prefix /image/usr/local \
    && deploy/container/collect_libraries /image/usr/local/bin/poise /image

FROM tools AS build
COPY . .
RUN --mount=type=cache,target=/root/.cache/ccache \
    scripts/install --build \
    && scripts/build release --target poise_programs \
       -DPOISE_BUILD_TESTS=OFF -DPOISE_BUILD_BENCH=OFF \
    && cmake --install build/release --strip --prefix /image/usr/local

# The command, the libraries it loads and their licences; no shell, no package manager.
FROM scratch AS poise-cli
COPY --from=build-cli /image /
USER 65532:65532
WORKDIR /work
ENTRYPOINT ["/usr/local/bin/poise"]

FROM ${BASE} AS poise
RUN apt-get update -q \
    && DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
       ca-certificates libabsl20220623 libbullet3.24 libcpp-httplib0.11 libfmt9 libgrpc++1.51 \
       libopenblas0-pthread libprometheus-cpp-core1.0 libprotobuf32 libspdlog1.10 libsqlite3-0 \
       libtorch1.13 libzip4 \
    && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/log/* \
    && install -d -o 65532 -g 65532 /var/lib/poise
COPY --from=build /image /
RUN ldd /usr/local/bin/* | (! grep "not found")
USER 65532:65532
VOLUME /var/lib/poise
EXPOSE 50051 9464
STOPSIGNAL SIGTERM
HEALTHCHECK --interval=15s --timeout=5s --start-period=30s CMD ["/usr/local/bin/poise", "health"]
ENTRYPOINT ["/usr/local/bin/poised"]
CMD ["--listen", "0.0.0.0:50051", "--metrics", "0.0.0.0:9464", "--data-dir", "/var/lib/poise"]
