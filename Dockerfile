# Plumbline in a container of Debian 12, built from this folder:
#
#   docker build -t plumbline .
#   docker run --rm -v "$PWD/data:/data" -w /data plumbline run MH_01_easy --out out
#
# `./test --full container` runs these steps in a bare Debian 12.
FROM debian:bookworm-slim
WORKDIR /plumbline
COPY . .
RUN tools/install_packages.sh
RUN cmake --preset release -DPLUMBLINE_TESTS=OFF -DPLUMBLINE_WERROR=OFF
RUN cmake --build --preset release --target plumbline
RUN cmake --install build/release --prefix /usr/local --component program
ENTRYPOINT ["plumbline"]
