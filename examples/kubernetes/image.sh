#!/usr/bin/env bash
# usage: examples/kubernetes/image.sh [NAME]
# Builds an OCI image with the command, by podman, buildah or docker, from this source tree.
set -euo pipefail
cd "$(dirname "$0")/../.."
name=${1:-launchdyn}
for engine in podman buildah docker; do
    command -v "$engine" >/dev/null && break
    engine=
done
[ -n "$engine" ] || { echo "image.sh: podman, buildah or docker is required" >&2; exit 3; }
exec "$engine" build -t "$name" -f examples/kubernetes/Containerfile .
