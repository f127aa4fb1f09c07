// Runs before the first paint, so that a page never flashes in the wrong theme.
(function () {
  var chosen = localStorage.getItem("fullpose.theme");
  var dark = chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = dark ? "dark" : "light";
})();
