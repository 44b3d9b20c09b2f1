// The button of the table of contents is a label, which keys do not reach: `site/build` makes it a button, this presses it.
document.getElementById('mdbook-sidebar-toggle')?.addEventListener('keydown', (event) => {
  if (event.key !== ' ' && event.key !== 'Enter') return;
  event.preventDefault();
  event.currentTarget.click();
});
