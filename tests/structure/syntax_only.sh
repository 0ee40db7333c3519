#!/bin/sh
# syntax_only.sh OBJECT COMPILER ARGUMENT...: reads the source as the compiler does, makes no code, and leaves an empty
# OBJECT as the sign that it compiles.
object=$1
shift
"$@" -fsyntax-only && : >"$object"
