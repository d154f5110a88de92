# The treerec program alone (docs/docker.md):
#   docker build -t treerec .
#   docker run --rm -v "$PWD:/data" --user "$(id -u):$(id -g)" treerec reconstruct scan.ply -o tree.glb
FROM debian:12-slim AS build
# Debian 12's compiler is the one that releases are made with. Its newest packages are what is meant.
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install -y --no-install-recommends \
        g++ libcgal-dev libglm-dev libstb-dev libtinygltf-dev nlohmann-json3-dev scons \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /source
COPY SConstruct ./
COPY src src
RUN scons -Q -j"$(nproc)" library=no cli=yes && strip bin/treerec

# Newer than the compiler's, since it has LASzip, which .laz scans are read with.
FROM debian:13-slim
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install -y --no-install-recommends liblaszip8 \
    && rm -rf /var/lib/apt/lists/*
# The program's sources are MIT; CGAL, which is inside, is GPL.
LABEL org.opencontainers.image.title="treerec" \
      org.opencontainers.image.description="Scanned trees into game-ready trees" \
      org.opencontainers.image.licenses="MIT AND GPL-3.0-or-later"
COPY --from=build /source/bin/treerec /usr/local/bin/treerec
COPY LICENSE /usr/share/doc/treerec/LICENSE
WORKDIR /data
USER 65534:65534
ENTRYPOINT ["treerec"]
CMD ["--help"]
