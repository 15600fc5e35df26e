// The button for the recording is replaced by the recording.
document$.subscribe(() => {
  for (const button of document.querySelectorAll("button.embed"))
    button.onclick = () => {
      const frame = document.createElement("iframe");
      Object.assign(frame, {src: button.dataset.address, title: "A recording", className: "embed"});
      button.replaceWith(frame);
    };
});
