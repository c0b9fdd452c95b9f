"""The web application of the live trainer: who may enter, what goes over the wire, when a client is shown out.

It knows neither tissue models nor contact. Whatever moves the tissue is handed in as a `LiveSource`
(`trocar.web.source`); `trocar.web.serve.serve` puts it behind the doors and onto the network.

| file | holds |
|---|---|
| `source` | what is asked of a source: snapshots, poses, beats |
| `messages`, `wire` | the text messages and the binary frames |
| `live` , `conversation` | the stream: all clients, and one client |
| `sessions`, `doors` | token, cookie, Host, Origin, response headers |
| `application`, `serve` | routes, and the server they run in |
| `typescript` | the same types for the browser client |
"""
