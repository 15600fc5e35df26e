// What scrolls can be scrolled by the keyboard, too.
document$.subscribe(() =>
  document.querySelectorAll(".md-typeset pre > code, .md-typeset__scrollwrap")
    .forEach(part => { part.tabIndex = 0; }));
