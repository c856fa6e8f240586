# fixtures/patches/teapot.bpt as a table in C: 16 control points of 3 numbers per surface, as they are written there.
BEGIN {
    print "// Made of fixtures/patches/teapot.bpt by tests/capi/run."
    print "static const float teapot[32][48] = {"
}
/^#/ { next }
NF == 3 {
    line = count % 16 ? line : "    {"
    for (k = 1; k <= 3; k++) line = line (index($k, ".") ? $k "f" : $k) ", "
    if (++count % 16 == 0) print line "},"
}
END {
    print "};"
    if (count != 32 * 16) exit 1
}
