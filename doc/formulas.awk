# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# A filter for Doxygen: turns the formulas of a header or a page, written in TeX between \f$ \f$ or
# \f[ \f], into HTML with Unicode letters. The pages then need neither MathJax (a network) nor
# LaTeX, and awk stands wherever a shell does. In CGAL's own tree the headers go through MathJax as
# they are, without this filter.
#
# Only the commands of the table below are known: any other stays in the text, and Doxygen stops at
# it.

BEGIN {
  split("alpha α beta β gamma γ delta δ epsilon ε theta θ lambda λ mu μ nu ν pi π rho ρ sigma σ tau τ phi φ psi ψ " \
        "omega ω eta η kappa κ xi ξ zeta ζ chi χ varepsilon ε varphi ϕ Pi Π Gamma Γ Theta Θ Xi Ξ Phi Φ Psi Ψ Lambda Λ Sigma Σ Delta Δ Omega Ω sum ∑ prod ∏ int ∫ top ⊤ dagger † cdot · times × le ≤ leq ≤ " \
        "ge ≥ geq ≥ ne ≠ neq ≠ approx ≈ sim ∼ in ∈ ni ∋ notin ∉ subset ⊂ cup ∪ cap ∩ forall ∀ exists ∃ to → infty ∞ partial ∂ nabla ∇ pm ± ldots … dots … cdots ⋯ " \
        "circ ∘ lVert ‖ rVert ‖ lvert | rvert | Vert ‖ ll ≪ gg ≫ mapsto ↦ langle ⟨ rangle ⟩ star ⋆ odot ⊙ ell ℓ", words, " ")
  for(i = 1; i in words; i += 2)
    symbol[words[i]] = words[i + 1]
  split("cot sin cos tan ln log exp min max det tr diag arg", words, " ")
  for(i = 1; i in words; ++i)
    symbol[words[i]] = words[i] " "
  symbol["quad"] = "&emsp;"
  symbol["qquad"] = "&emsp;&emsp;"
  symbol["left"] = symbol["right"] = symbol["big"] = symbol["Big"] = symbol["bigl"] = symbol["bigr"] = symbol["Bigl"] = symbol["Bigr"] = ""
  text = ""
}

# A block ```math of a page is a formula as well.
/^```math$/ { text = text "\\f[\n"; math = 1; next }
math && /^```$/ { text = text "\\f]\n"; math = 0; next }
{ text = text $0 "\n" }

END {
  out = ""
  while(match(text, /\\f[$\[]/)) {
    display = substr(text, RSTART + 2, 1) == "["
    out = out substr(text, 1, RSTART - 1)
    text = substr(text, RSTART + 3)
    end = index(text, display ? "\\f]" : "\\f$")
    if(end == 0)
      break # Doxygen reports the open formula
    html = substr(text, 1, end - 1)
    gsub(/^ +| +$/, "", html)
    html = convert(html)
    out = out (display ? "<center>" html "</center>" : html)
    text = substr(text, end + 3)
  }
  out = out text
  gsub(/Eq\. /, "Eq.\\\\ ", out) # or a first sentence ends there
  gsub(/et al\. /, "et al.\\\\ ", out)
  printf "%s", out
}

# Takes one argument off the global `rest`: a group in braces, a command, or one character.
function argument(    depth, i, c, a)
{
  sub(/^ +/, "", rest)
  if(substr(rest, 1, 1) == "{") {
    depth = 0
    for(i = 1; i <= length(rest); ++i) {
      c = substr(rest, i, 1)
      if(c == "{")
        ++depth
      else if(c == "}" && --depth == 0)
        break
    }
    a = substr(rest, 2, i - 2)
    rest = substr(rest, i + 1)
    return a
  }
  if(match(rest, /^\\([A-Za-z]+|.)/)) {
    a = substr(rest, 1, RLENGTH)
    rest = substr(rest, RLENGTH + 1)
    if(a ~ /^\\(widetilde|tilde|hat|bar)$/)
      a = a "{" argument() "}"
    return a
  }
  a = substr(rest, 1, 1)
  rest = substr(rest, 2)
  return a
}

# The HTML of an argument, leaving `rest` where it was.
function nested(a,    saved, html)
{
  saved = rest
  html = convert(a)
  rest = saved
  return html
}

function fenced(a)
{
  return a ~ /^(\\?[A-Za-z]+|[0-9.]+)$/ ? nested(a) : "(" nested(a) ")"
}

# An accent stands behind the first letter: a combining character, inside of its emphasis.
function accented(html, mark)
{
  return html ~ /^<em>.<\/em>/ ? "<em>" substr(html, 5, 1) mark substr(html, 6) : "<em>" html mark "</em>"
}

function command(name,    a, b, html)
{
  if(name ~ /^(widetilde|tilde)$/)
    return accented(nested(argument()), "\314\203")
  if(name == "hat")
    return accented(nested(argument()), "\314\202")
  if(name == "bar")
    return accented(nested(argument()), "\314\204")
  if(name == "frac") {
    a = argument()
    b = argument()
    html = fenced(a) " / " fenced(b)
    return rest ~ /^ *(\\(left)?[({[A-Za-z]|[A-Za-z(])/ && rest !~ /^ *\\right/ ? "(" html ")" : html
  }
  if(name == "tag")
    return "&emsp;(" argument() ")"
  if(name == "sqrt")
    return "√" fenced(argument())
  if(name ~ /^(mbox|text|mathrm|operatorname)$/)
    return argument()
  if(name ~ /^(mathbf|mathit|mathcal)$/)
    return nested(argument())
  return name in symbol ? symbol[name] : "\\" name
}

function convert(formula,    html, name, a, c)
{
  html = ""
  rest = formula
  while(rest != "") {
    if(match(rest, /^\n *(\/\/\/|\*)?/)) { # the line goes on behind the next comment leader
      html = html substr(rest, 1, RLENGTH) " "
      rest = substr(rest, RLENGTH + 1)
      if(rest ~ /^ *[+]/)
        html = html "&nbsp;" # or Markdown sees a list
    } else if(match(rest, /^\\[A-Za-z]+/)) {
      name = substr(rest, 2, RLENGTH - 1)
      rest = substr(rest, RLENGTH + 1)
      html = html command(name)
    } else if(match(rest, /^\\[|{},;:! ]/)) {
      c = substr(rest, 2, 1)
      rest = substr(rest, 3)
      html = html (c == "|" ? "‖" : c ~ /[{}]/ ? c : c == "!" ? "" : " ")
    } else if(match(rest, /^[_^]/)) {
      name = substr(rest, 1, 1) == "_" ? "sub" : "sup"
      rest = substr(rest, 2)
      a = argument()
      html = html "<" name ">" nested(a) "</" name ">"
    } else if(match(rest, /^[A-Za-z]+/)) {
      html = html "<em>" substr(rest, 1, RLENGTH) "</em>"
      rest = substr(rest, RLENGTH + 1)
    } else {
      c = substr(rest, 1, 1)
      rest = substr(rest, 2)
      if(c == "<") c = "&lt;"
      else if(c == ">") c = "&gt;"
      else if(c == "&") c = "&amp;"
      else if(c == "-") c = "−"
      else if(c == "'") c = "′"
      else if(c == "*") c = "∗"
      else if(c == "{" || c == "}") c = ""
      html = html c
    }
  }
  return html
}
