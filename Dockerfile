# Image with the installed package, on Debian 12. Its two stages were tried on bare Debian systems, not yet by docker:
#   docker build -t hammer_loads .
#   docker run --rm -v "$PWD/demo_output:/output" hammer_loads
#   docker run --rm --network host hammer_loads roslaunch hammer_loads hammer_loads.launch
FROM debian:12 AS build
RUN apt-get update && apt-get install -y --no-install-recommends git
COPY . /source
RUN /source/scripts/deb /packages

FROM debian:12
COPY --from=build /packages/*.deb /packages/
RUN apt-get update \
  && apt-get install -y --no-install-recommends /packages/hammer-loads_*.deb \
  && rm -rf /var/lib/apt/lists/* /packages
CMD ["rosrun", "hammer_loads", "demo", "/output"]
