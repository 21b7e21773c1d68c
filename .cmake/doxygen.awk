# Doxygen's input filter: the comments of the headers, which are written to be read there, as Doxygen's own. A comment
# belongs to the declarations below it, up to an empty line; one behind a declaration belongs to that.

# The text of a comment: what Doxygen would take for commands, tags or links is none.
function escaped(text) {
    if (text ~ /^     /) return text  # a matrix or a formula, as it stands
    gsub(/[\\@#<>&%~$]/, "\\\\&", text)
    if (match(text, /^ (Guarantee|Shapes?|Bad input|Source|Cost|Precondition)[^.:]*: /))
        return "\n/// **" substr(text, 2, RLENGTH - 3) "**:" substr(text, RLENGTH)
    if (match(text, /^   [^ ]+((, | )[^ ]+)*   *[^ ]/))
        return " - **" name_of(text) "** " rest_of(text)
    sub(/^   +/, "   ", text)
    return text
}
function name_of(text) { sub(/^ +/, "", text); sub(/  .*/, "", text); return text }
function rest_of(text) { sub(/^ +/, "", text); sub(/^[^ ]+( [^ ]+)*  +/, "", text); return text }

function write_comment(  i) {
    for (i = 1; i <= count; ++i) print indentation "///" comment[i]
}

# What stands above a declaration: its comment, or a word that the class describes its members.
function write_description(code) {
    if (count) write_comment()
    else if (is_described[depth] && code !~ / \/\/\/?/) print "/// See the description of the class."
}

# Members of one declaration, one by one: Doxygen would describe the first alone.
function write_names(code,  type, behind, names, n, i) {
    gsub(/ = [{][}]/, "", code)
    if (!is_described[depth] || code !~ /^ +[^(={]* [a-z_]+(, [a-z_]+)+;/) return 0
    behind = code ~ / \/\/ / ? code : ""
    sub(/.* \/\/ /, "  ///< ", behind)
    sub(/;.*/, "", code)
    type = code
    sub(/[a-z_]+(, [a-z_]+)+$/, "", type)
    n = split(substr(code, length(type) + 1), names, ", ")
    for (i = 1; i <= n; ++i) {
        write_description(behind)
        print type names[i] ";" behind
    }
    return 1
}

# Counts the braces of a line of code: only what namespaces, classes and enumerations hold is declared.
function follow(code,  i, c, declares) {
    gsub(/template <[^>]*>/, "", code)
    gsub(/"([^"\\]|\\.)*"/, "", code)
    gsub(/'.'/, "", code)
    declares = code ~ /(namespace|class|struct|enum|extern) / && code !~ /[=(]/
    for (i = 1; i <= length(code); ++i) {
        c = substr(code, i, 1)
        if (c == "{") {
            scope[++depth] = declares && scope[depth - 1]
            is_build[depth] = code ~ /^inline namespace TEXGEN_/
            is_described[depth] = count > 0 && code !~ /namespace /
        }
        if (c == "}") --depth
    }
}

BEGIN { scope[depth = 0] = 1 }

# The README's links lead to the pages of the headers, and to nothing that has no page.
FILENAME ~ /\.md$/ {
    gsub(/\(include\/texgen\//, "(@ref ")
    while (match($0, /\]\(tests\/[^)]*\)/)) {
        text = substr($0, 1, RSTART - 1)
        sub(/\[[^[]*$/, "", text)
        $0 = text substr($0, length(text) + 2, RSTART - length(text) - 2) substr($0, RSTART + RLENGTH)
    }
    print
    next
}

# The namespace of all, without GLM's aligned types.
{ sub(/TEXGEN_NAMESPACE/, "texgen") }

# What a namespace holds is described in its headers.
/^namespace / { print "/// " ($2 ~ /reference/ ? "The definitions, for any scalar type." : "All of the library.") }

/^ *\/\// {
    if (!scope[depth]) { print ""; next }
    if (!is_open) count = 0
    is_open = 1
    indentation = $0
    sub(/\/\/.*/, "", indentation)
    text = $0
    sub(/^ *\/\//, "", text)
    # A list ends where the text goes on in its first column.
    if (count && comment[count] ~ /^   |^ - / && text ~ /^ [^ ]/) text = "\n///" escaped(text)
    else text = escaped(text)
    comment[++count] = text
    next
}

/^ *$/ {
    # What stands apart is of the file.
    if (is_open && comment[1] !~ /^ ----/) { comment[1] = " \\file\n///" comment[1]; write_comment() }
    is_open = count = 0
    print
    next
}

{
    code = $0
    is_open = 0
    declares = scope[depth] && !is_continued && code !~ /^ *(}|#|(public|private|protected):)/
    if (!declares || !write_names(code)) {
        if (declares) write_description(code)
        # An enumeration on one line: behind it Doxygen would describe the last enumerator.
        if (declares && code ~ /^enum .*};  *\/\/ /) {
            print "/// " substr(code, index(code, "// ") + 3)
            sub(/  *\/\/ .*/, "", code)
        }
        if (declares) sub(/ \/\/ /, " ///< ", code)
        # The namespace that a macro names is transparent.
        print code ~ /^inline namespace TEXGEN_[A-Z]+ [{]$/ || (is_build[depth] && code ~ /^}/) ? "" : code
    }
    sub(/ *\/\/.*/, "", code)
    is_continued = scope[depth] && (code ~ /^ *template </ || code !~ /[;{}:]$/) && code !~ /^#/
    before = depth
    follow(code)
    if (depth > before && scope[depth]) count = 0
}
