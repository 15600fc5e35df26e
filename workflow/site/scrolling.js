// What scrolls can be scrolled by the keyboard, too; a figure does so in a narrow window alone.
document$.subscribe(() =>
  document.querySelectorAll(".md-typeset :is(pre > code, .md-typeset__scrollwrap, p:has(> img))")
    .forEach(part => { if (part.tagName !== "P" || part.scrollWidth > part.clientWidth) part.tabIndex = 0; }));
