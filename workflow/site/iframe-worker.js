// Browsers start no workers from local files, so the site's search uses a hidden frame instead.
if (location.protocol === "file:")
  window.Worker = window.IFrameWorker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      window.answer = data => this.dispatchEvent(new MessageEvent("message", { data }));
      frame.srcdoc = `<script>postMessage = parent.answer</script><script src="${url}"></script>`;
      frame.hidden = true;
      frame.title = "search";
      this.frame = new Promise(ready => frame.addEventListener("load", () => ready(frame)));
      document.body.append(frame);
    }
    async postMessage(data) {
      (await this.frame).contentWindow.dispatchEvent(new MessageEvent("message", { data }));
    }
  };
