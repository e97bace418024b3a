#!/usr/bin/env bash
# The measured pages of docs/. Without a name it says which are stale: what they measure has changed since they were written. With the
# name of a page it runs the command of that page and notes at its foot what was measured.
#
#   tests/pages.sh [NAME]
set -euo pipefail
cd "$(dirname "$0")/.."

# The hash of all files of some folders, but for what was built there.
hash_of() {
    find "$@" -name target -prune -o -type f -print0 | LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum | cut -c1-16
}

# The hash at the foot of a page; nothing where there is none.
noted() {
    sed -n 's/^<!-- measured: \([0-9a-f]*\) -->$/\1/p' "docs/$1.md"
}

is_known=no
while IFS='|' read -r name sources command; do
    name="${name// /}"
    [[ -z "$name" || "$name" == \#* ]] && continue
    read -ra sources <<<"$sources"
    if [[ $# -eq 0 ]]; then
        [[ "$(noted "$name")" == "$(hash_of "${sources[@]}")" ]] || echo "stale: docs/$name.md (tests/pages.sh $name writes it anew)"
    elif [[ "$1" == "$name" ]]; then
        is_known=yes
        measured="$(hash_of "${sources[@]}")"
        [[ -n "${command// /}" ]] || command="$(sed -n '0,/`cargo run/s/.*`\(cargo run[^`]*\)`.*/\1/p' "docs/$name.md" | head -1)"
        echo "$command" >&2
        bash -c "$command" </dev/null
        sed -i '/^<!-- measured: /d' "docs/$name.md"
        sed -i -e '$a\' "docs/$name.md"
        echo "<!-- measured: $measured -->" >>"docs/$name.md"
    fi
done <tests/pages.txt
if [[ $# -gt 0 && $is_known == no ]]; then
    echo "no page of that name in tests/pages.txt: $1" >&2
    exit 2
fi
