#!/bin/sh
# SPDX-License-Identifier: MIT
# validate.sh WRITE_MODELS FOLDER: lets WRITE_MODELS write models into FOLDER and gltf-validator judge them. 77: it is not
# installed.
set -eu
module=${TAUT_GLTF_VALIDATOR:-${XDG_CACHE_HOME:-$HOME/.cache}/taut/gltf-validator}/node_modules/gltf-validator
if ! command -v node >/dev/null || [ ! -d "$module" ]; then
    echo "skipped: there is no gltf-validator; scripts/setup --with-validator installs it"
    exit 77
fi
"$1" "$2"
exec node "$(dirname "$0")/validate.mjs" "$module" "$2"
