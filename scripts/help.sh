# shellcheck shell=bash
# What every script answers to --help: the comment at its beginning. Sourced right behind it, with its arguments.
for argument in "$@"; do
    case $argument in
        -h | --help) sed -n '2,/^[^#]/{/^[^#]/d;s/^# \{0,1\}//p}' "$0"; exit 0 ;;
    esac
done
