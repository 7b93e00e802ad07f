#!/bin/sh
# Make sure that there is Khronos' glTF validator for the tests of exports; without it, or without
# node, they are skipped.
set -u
there=build/node/node_modules/gltf-validator
[ -d "$there" ] && exit 0
if command -v npm >/dev/null 2>&1; then
  mkdir -p build/node
  npm install --silent --no-audit --no-fund --prefix build/node gltf-validator@2.0.0-dev.3.10 \
    >/dev/null 2>&1 && exit 0
fi
echo "no glTF validator (node and npm): the tests that need it are skipped"
exit 0
